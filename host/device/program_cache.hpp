// SPDX-License-Identifier: MIT
// On-disk cache of compiled programs: later runs compile nothing. Gain with a driver that keeps
// none, Intel's for CPUs: 2.5 to 3.0 s for an image in place of 22 to 25 (docs/devices.md, 'Caches
// of compiled kernels').
//
// One file per program. The file holds the full key (device, driver, settings, options, source
// text), which load() compares: sources whose file names collide never share a program. Files
// appear by rename, so several processes may read and write one folder at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "support/cache_folder.hpp"

namespace clpv {

/// Cache of program binaries in one folder.
class ProgramCache {
 public:
  using Binary = std::vector<unsigned char>;

  /// Cache of about `max_bytes` at most in `folder`; store() evicts the least recently used files.
  explicit ProgramCache(std::filesystem::path folder, std::uint64_t max_bytes = kDefaultMaxBytes);

  /// The user's cache: $XDG_CACHE_HOME/clpv, else $HOME/.cache/clpv. None if neither is an
  /// absolute path, if CLPV_PROGRAM_CACHE is "off", or if the driver keeps compiled kernels itself,
  /// unless CLPV_PROGRAM_CACHE is "on".
  static std::optional<ProgramCache> of_user(const Device& device);

  /// Cache key of a program: device, driver and its settings, build options and text, in full.
  static std::string key(const Device& device, const std::string& options, const std::string& text);

  /// Returns the binary stored under `key`; nothing if the file is missing, damaged or has another
  /// key.
  std::optional<Binary> load(const std::string& key) const;

  /// Stores `binary` under `key`, replacing any other. On failure (folder not writable, disk full)
  /// warns with the reason and returns false: a cache never makes the program fail.
  bool store(const std::string& key, const Binary& binary) const;

  /// Removes a binary that the driver rejected, if it exists.
  void remove(const std::string& key) const;

  std::filesystem::path file_of(const std::string& key) const;
  const std::filesystem::path& folder() const { return folder_.path(); }

  static constexpr std::uint64_t kDefaultMaxBytes = 256u << 20;  // a few hundred programs of PoCL

 private:
  CacheFolder folder_;
  std::uint64_t max_bytes_;
};

}  // namespace clpv
