// SPDX-License-Identifier: MIT
// Compiled programs kept on disk between runs, so that a second start compiles nothing.
//
// One file a program. It holds the whole key (device, driver, options, source text), which is compared when
// read: two sources with the same file name never take each other's program. Files appear by rename, so that
// several processes may read and write one folder at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "device/device.hpp"

namespace clpv {

class ProgramCache {
 public:
  using Binary = std::vector<unsigned char>;

  /// Keeps at most about `max_bytes` in `folder`: storing drops the files that were used least recently.
  explicit ProgramCache(std::filesystem::path folder, std::uint64_t max_bytes = kDefaultMaxBytes);

  /// The user's: $XDG_CACHE_HOME/clpv, else $HOME/.cache/clpv. None where neither variable is set, or where
  /// CLPV_PROGRAM_CACHE is "off".
  static std::optional<ProgramCache> of_user();

  /// What a program depends on, in full: the device, its driver, build options and text.
  static std::string key(const Device& device, const std::string& options, const std::string& text);

  /// The binary stored under `key`; nothing where there is none, or where the file is damaged or of another
  /// key.
  std::optional<Binary> load(const std::string& key) const;

  /// Stores `binary`, replacing what is there. Where that fails (folder not writable, disk full) the log says
  /// so at -v, and the result is false: a cache is never a reason to fail.
  bool store(const std::string& key, const Binary& binary) const;

  void remove(
      const std::string& key) const;  ///< a binary that the driver rejected; nothing where there is none

  std::filesystem::path file_of(const std::string& key) const;
  const std::filesystem::path& folder() const { return folder_; }

  static constexpr std::uint64_t kDefaultMaxBytes = 256u << 20;  // a few hundred programs of PoCL's

 private:
  void drop_oldest() const;

  std::filesystem::path folder_;
  std::uint64_t max_bytes_;
};

}  // namespace clpv
