// SPDX-License-Identifier: MIT
#include "device/driver_cache.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <set>
#include <string_view>
#include <system_error>

#include "support/cache_folder.hpp"
#include "support/input_file.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariable = "POCL_CACHE_DIR";

/// A scratch folder until this process ends; a fork of it leaves the folder alone.
struct FolderOfProcess {
  std::unique_ptr<ScratchFolder> folder;
  pid_t owner = ::getpid();

  const fs::path& path() {
    if (!folder) folder = std::make_unique<ScratchFolder>();
    return folder->path();
  }
  ~FolderOfProcess() {
    if (::getpid() != owner) static_cast<void>(folder.release());
  }
};

}  // namespace

bool driver_keeps_kernels(const Device& device) {
  return device.platform == "Portable Computing Language";
}

void choose_driver_cache() {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  if (driver_cache_folder()) return;
  std::string why = "neither XDG_CACHE_HOME nor HOME is an absolute path";
  fs::path folder;
  if (const auto cache = user_cache_folder()) {
    folder = *cache / "pocl";
    why = CacheFolder(folder).problem();
  }
  if (!why.empty()) {
    static FolderOfProcess scratch;
    folder = scratch.path();
    log_warning("{}: each run compiles its kernels again", why);
  }
  ::setenv(kVariable, folder.c_str(), 1);
}

std::optional<fs::path> driver_cache_folder() {
  const char* set = std::getenv(kVariable);
  return set != nullptr && *set != '\0' ? std::optional<fs::path>(set) : std::nullopt;
}

CompiledMarks::CompiledMarks(const Device& device) {
  if (!driver_keeps_kernels(device)) return;
  if (const auto cache = driver_cache_folder()) folder_.emplace(*cache / "clpv");
}

bool CompiledMarks::has(const std::string& program) const {
  return folder_ && folder_->read(program).has_value();
}

void CompiledMarks::add(const std::string& program) const {
  if (!folder_) return;
  const std::string why = folder_->write(program, std::string_view(""));
  if (!why.empty())
    log_debug("no mark of compiled kernels: {}", why);  // costs later runs their helpers' start
}

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
