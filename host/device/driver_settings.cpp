// SPDX-License-Identifier: MIT
#include "device/driver_settings.hpp"

#include <unistd.h>

#include <algorithm>
#include <set>
#include <string_view>

namespace clpv {
namespace {

// PoCL, Intel's runtimes, Mesa (rusticl, llvmpipe), NVIDIA, AMD.
constexpr std::string_view kPrefixes[] = {"POCL_",    "CL_CONFIG_", "IGC_",  "RUSTICL_", "LP_",
                                          "GALLIUM_", "GALLIVM_",   "CUDA_", "GPU_",     "AMD_"};
constexpr std::string_view kCaches[] = {"POCL_CACHE_DIR", "POCL_KERNEL_CACHE", "CUDA_CACHE_PATH"};
constexpr std::string_view kThreads[] = {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT",
                                         "POCL_AFFINITY", "LP_NUM_THREADS"};

bool counts(std::string_view name, DriverSettings which) {
  const auto starts = [&](std::string_view prefix) { return name.starts_with(prefix); };
  if (std::ranges::none_of(kPrefixes, starts) || std::ranges::count(kCaches, name) > 0)
    return false;
  return which == DriverSettings::all || std::ranges::count(kThreads, name) == 0;
}

}  // namespace

std::string driver_settings(DriverSettings which) {
  std::set<std::string> lines;
  for (char** variable = ::environ; variable != nullptr && *variable != nullptr; ++variable) {
    const std::string_view line = *variable;
    if (counts(line.substr(0, line.find('=')), which)) lines.emplace(line);
  }
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

}  // namespace clpv
