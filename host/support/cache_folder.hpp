// SPDX-License-Identifier: MIT
// A cache on disk: entries that later runs of this user read, and that may be lost or damaged at
// any time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <string_view>

#include "support/input_file.hpp"

namespace clpv {

/// A folder of cache entries. Nobody else may have written what is read from it: the folder and
/// each entry belong to this user or root, and only their owner can write the folder. No function
/// throws, since a cache never ends a run.
class CacheFolder {
 public:
  explicit CacheFolder(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }

  /// Returns the bytes of an entry; nothing if it or the folder is of someone else, if it is not a
  /// regular file (a symbolic link is none), longer than `limit` bytes, or missing. Whether the
  /// content is sound is for the caller to check.
  std::optional<std::string> read(const std::string& name,
                                  std::uintmax_t limit = kMaxFileBytes) const;

  /// Writes an entry, as a whole, in place of anything that has its name; does not follow links.
  /// Creates the folder for its owner only (0700). Returns the reason of a failure, else "".
  std::string write(const std::string& name, std::span<const std::byte> bytes) const;
  std::string write(const std::string& name, std::string_view text) const {
    return write(name, std::as_bytes(std::span(text)));
  }

  /// Writes an entry as write() does, with a checksum, which read_checked() removes. read_checked()
  /// returns nothing for damaged bytes, too.
  std::string write_checked(const std::string& name, std::string bytes) const;
  std::optional<std::string> read_checked(const std::string& name) const;

  /// Removes entries that were not written or used for longer than `age`, and the oldest of the
  /// others beyond `bytes` in total. Only files whose whole names match `own`.
  void evict(const std::regex& own, std::uint64_t bytes,
             std::filesystem::file_time_type::duration age =
                 std::filesystem::file_time_type::duration::max()) const;

  /// Returns the reason why write() would fail, else "". Changes nothing.
  std::string problem() const;

 private:
  template <typename Use>
  std::string with_file(const std::string& name, const Use& use) const;

  std::filesystem::path path_;
};

// A temporary folder, which disappears with the process that made it.

/// A new folder .clpv-run-XXXXXX in $TMPDIR, or in /tmp, that only this user can read.
class ScratchFolder {
 public:
  /// Throws Error(run_time) that names TMPDIR if the folder cannot be made.
  ScratchFolder();
  ~ScratchFolder();  ///< removes it with all it holds
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace clpv
