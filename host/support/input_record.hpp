// SPDX-License-Identifier: MIT
// The files that a command reads, so that none of its outputs replaces one of them.
#pragma once

#include <sys/types.h>

#include <compare>
#include <filesystem>
#include <optional>
#include <string>

namespace clpv {

/// A file and what names it, for errors: an option, or a document and the place in it. An empty
/// path means that the option is not given. `derived`: an output whose name clpv makes, in a folder
/// or beside a file that the option names.
struct NamedFile {
  std::string option;
  std::filesystem::path path;
  bool derived = false;
};

/// Device and inode of a file, so that links and hard links are the file itself. For a file that
/// does not exist: those of its folder, and its name.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;
  std::string name;
  auto operator<=>(const FileIdentity&) const = default;
};

/// Returns the identity of the file that `path` leads to.
FileIdentity identity_of(const std::filesystem::path& path);

/// Returns `path` with its symbolic links resolved, those to files that do not exist yet too.
std::filesystem::path follow_links(const std::filesystem::path& path, std::error_code& error);

/// Records input files during its lifetime; at most one lives. Without one, as in the library, the
/// caller decides what to overwrite, and the functions do nothing.
class InputRecord {
 public:
  InputRecord();
  ~InputRecord();
  InputRecord(const InputRecord&) = delete;
  InputRecord& operator=(const InputRecord&) = delete;

  /// Adds a file, as read_file() does for each file that it opens. Its first name counts.
  static void add(const NamedFile& input);
  /// Returns the input that is this file, if any.
  static std::optional<NamedFile> find(const FileIdentity& file);
  /// Ends recording, but keeps the record: for commands that go on to read their own outputs.
  static void close();
};

}  // namespace clpv
