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

/// PoCL's cache folder: POCL_CACHE_DIR, else below XDG_CACHE_HOME, else below HOME.
std::optional<std::filesystem::path> driver_cache_folder();

/// Returns true if the disk of that folder has no space left.
bool driver_cache_is_full();

/// Marks of programs whose kernels PoCL has compiled, in PoCL's cache folder: they disappear with
/// it. Only PoCL compiles at the first launch and caches the result for all processes, so other
/// drivers have no marks.
class CompiledMarks {
 public:
  explicit CompiledMarks(const Device& device);
  bool available() const { return folder_.has_value(); }
  /// Returns true if the kernels of the program with this ProgramCache::key are compiled.
  bool has(const std::string& key) const;
  void add(const std::string& key) const;

 private:
  std::optional<CacheFolder> folder_;
};

}  // namespace clpv
