// SPDX-License-Identifier: MIT
// PoCL's own cache of compiled kernels, which clpv's processes share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "device/device.hpp"
#include "support/cache_folder.hpp"

namespace clpv {

/// Returns true if the driver keeps compiled kernels itself, for all processes: PoCL.
bool driver_keeps_kernels(const Device& device);

/// Sets POCL_CACHE_DIR, unless the user has, before PoCL reads it: to a folder of the user's cache
/// that nobody else can write (user_cache_folder(), CacheFolder), else, with a warning, to a
/// ScratchFolder of this process. Without it PoCL loads code from /tmp/pocl or from the current
/// folder where HOME is missing or relative. Helpers inherit the variable. Throws as ScratchFolder.
void choose_driver_cache();

/// POCL_CACHE_DIR; nothing before choose_driver_cache().
std::optional<std::filesystem::path> driver_cache_folder();

/// Marks of programs whose kernels PoCL has compiled, in PoCL's cache folder: they disappear with
/// it. Later runs start no helpers, which would set up the scene and the frame for nothing. Only
/// PoCL compiles at the first launch and caches the result for all processes, so other drivers have
/// no marks.
class CompiledMarks {
 public:
  explicit CompiledMarks(const Device& device);
  bool available() const { return folder_.has_value(); }
  /// Returns true if the kernels of the program with this Program::hash are compiled.
  bool has(const std::string& program) const;
  void add(const std::string& program) const;

 private:
  std::optional<CacheFolder> folder_;
};

// Environment variables that change what OpenCL drivers do.

enum class DriverSettings {
  compilation,  ///< those that may change what kernels compute
  all           ///< also those that only change times, such as the number of threads
};

/// Returns "NAME=VALUE" of the variables that drivers read, by their prefixes, sorted, one a line;
/// caches are left out. Part of keys of programs, pixels and times.
std::string driver_settings(DriverSettings which);

}  // namespace clpv
