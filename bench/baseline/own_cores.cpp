// SPDX-License-Identifier: MIT
#include "bench/baseline/own_cores.hpp"

#include <vector>

#if defined(_OPENMP) && defined(__linux__)
#include <omp.h>
#include <sched.h>
#endif

namespace clpv::bench {

#if defined(_OPENMP) && defined(__linux__)

namespace {

/// Those that this process may use.
std::vector<int> cores_allowed() {
  cpu_set_t allowed;
  std::vector<int> cores;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return cores;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &allowed)) cores.push_back(core);
  }
  return cores;
}

}  // namespace

void give_threads_own_cores() {
  static const std::vector<int> cores = cores_allowed();  // while the first thread may still use them all
#pragma omp parallel
  {
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    if (static_cast<std::size_t>(omp_get_num_threads()) <= cores.size()) {
      cpu_set_t own;
      CPU_ZERO(&own);
      CPU_SET(cores[thread], &own);
      sched_setaffinity(0, sizeof own, &own);
    }
  }
}

#else

void give_threads_own_cores() {}

#endif

}  // namespace clpv::bench
