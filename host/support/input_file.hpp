// SPDX-License-Identifier: MIT
// Reads whole regular files of bounded size. Folders and devices are rejected first, since streams
// open them too.
#pragma once

#include <sys/types.h>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

inline constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1}
                                                << 28;  ///< more than any cache or report

/// Returns the bytes of a regular file that clpv may itself have written; nothing if it is missing,
/// unreadable or longer than `limit` bytes.
std::optional<std::string> file_bytes(const std::filesystem::path& path,
                                      std::uintmax_t limit = kMaxFileBytes);

using Bytes = std::vector<std::uint8_t>;

/// Returns the bytes of an input, a regular file, and adds it to the InputRecord. `file` and
/// `place` name the document that refers to it, for errors. Throws Error(bad_input) if it is
/// missing, not a regular file, unreadable or longer than `limit` bytes.
Bytes read_file(const std::filesystem::path& path, std::uint64_t limit, const std::string& file,
                std::string_view place = {});

/// Returns $XDG_CACHE_HOME/clpv, else $HOME/.cache/clpv; nothing if neither is an absolute path.
/// Does not create the folder.
std::optional<std::filesystem::path> user_cache_folder();

// The files that a command reads, so that none of its outputs replaces one of them.

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
