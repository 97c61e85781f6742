// SPDX-License-Identifier: MIT
#include "parallel/launched.hpp"

#include <dlfcn.h>

#include <cstdlib>

#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

constexpr const char* kModule = "clpv_mpi.so";  // found by the program's RUNPATH

/// A number of the environment; nothing where there is none.
std::optional<int> number(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? std::nullopt : parse_number<int>(text);
}

}  // namespace

std::optional<Launched> launched() {
  for (const auto& [rank, size] : {std::pair{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                   {"PMI_RANK", "PMI_SIZE"},
                                   {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}}) {
    if (const auto found = number(rank)) return Launched{*found, number(size)};
  }
  return std::nullopt;
}

std::unique_ptr<Messages> start_messages() {
  // MPI's own modules look for its symbols among those of all.
  void* module = ::dlopen(kModule, RTLD_NOW | RTLD_GLOBAL);
  if (module == nullptr) {
    throw Error(ExitCode::run_time,
                "started as one of several processes, but without MPI: {}; build with CLPV_MPI where MPI is "
                "(Debian: libopenmpi-dev)",
                ::dlerror());
  }
  const auto make = reinterpret_cast<MakeMessages*>(::dlsym(module, kMakeMessages));
  if (make == nullptr) throw Error(ExitCode::run_time, "{}: {}", kModule, ::dlerror());
  return std::unique_ptr<Messages>(make());
}

}  // namespace clpv
