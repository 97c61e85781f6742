// SPDX-License-Identifier: MIT
#include "support/limits.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "support/error.hpp"

namespace clpv {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;
// Address space of PoCL 3.1: the first is LLVM and its modules, the second three threads per core
// with 8 MiB of stack and 64 MiB of heap each. Measured on two cores: 690 MiB from opening the
// device to the end of a small frame.
constexpr std::uint64_t kCompilerBytes = 512 * kMiB, kCoreBytes = 128 * kMiB;
constexpr std::uint64_t kLeastLeft = 64 * kMiB;
constexpr std::uint64_t kLeastFiles = 64;        // libraries, a linker's inputs, caches
constexpr std::uint64_t kLeastFileBytes = kMiB;  // compiled kernels have 0.1 MiB
// PoCL's threads get stacks of this size, and its compiler recurses: with 64 KiB they crash.
constexpr std::uint64_t kLeastStack = 512 * 1024;

std::uint64_t limit_of(int resource) {
  rlimit limit{};
  if (::getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 ||
      limit.rlim_cur == RLIM_INFINITY)
    return kUnlimited;
  return limit.rlim_cur;
}

std::uint64_t address_space_in_use() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t driver_bytes() {
  const long cores = ::sysconf(_SC_NPROCESSORS_ONLN);
  return kCompilerBytes + kCoreBytes * static_cast<std::uint64_t>(std::max(1L, cores));
}

}  // namespace

std::uint64_t address_space_left() {
  const std::uint64_t limit = limit_of(RLIMIT_AS), taken = address_space_in_use() + driver_bytes();
  if (limit == kUnlimited) return kUnlimited;
  return limit > taken ? limit - taken : 0;
}

void require_limits() {
  if (address_space_left() < kLeastLeft) {
    throw Error(ExitCode::run_time,
                "address space (ulimit -v): found {} MiB, allowed for OpenCL: {} or more",
                limit_of(RLIMIT_AS) / kMiB,
                (address_space_in_use() + driver_bytes() + kLeastLeft) / kMiB + 1);
  }
  if (const std::uint64_t files = limit_of(RLIMIT_NOFILE); files < kLeastFiles) {
    throw Error(ExitCode::run_time,
                "open files (ulimit -n): found {}, allowed for OpenCL: {} or more", files,
                kLeastFiles);
  }
  if (const std::uint64_t bytes = limit_of(RLIMIT_STACK); bytes < kLeastStack) {
    throw Error(ExitCode::run_time,
                "stack (ulimit -s): found {} KiB, allowed for OpenCL: {} or more", bytes / 1024,
                kLeastStack / 1024);
  }
  if (const std::uint64_t bytes = limit_of(RLIMIT_FSIZE); bytes < kLeastFileBytes) {
    throw Error(ExitCode::run_time,
                "file size (ulimit -f): found {} KiB, allowed for OpenCL: {} or more", bytes / 1024,
                kLeastFileBytes / 1024);
  }
}

std::string limits_note() {
  std::string limits;
  if (const std::uint64_t bytes = limit_of(RLIMIT_AS); bytes != kUnlimited)
    limits = fmt::format("{} MiB of address space (ulimit -v)", bytes / kMiB);
  if (const std::uint64_t files = limit_of(RLIMIT_NOFILE); files < kLeastFiles)
    limits += fmt::format("{}{} open files (ulimit -n)", limits.empty() ? "" : ", ", files);
  return limits.empty() ? "" : "; limits of this process: " + limits;
}

}  // namespace clpv
