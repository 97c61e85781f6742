// SPDX-License-Identifier: MIT
// Atomic file output: a temporary file in the same folder, renamed into place.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// A file under a temporary name in the folder of its target. Readers see the old or the new
/// target, never a partial one.
class OutputFile {
 public:
  enum class Links {
    follow,  ///< a symbolic link is kept, and its target replaced
    replace  ///< whatever has the name is replaced, as in a cache
  };

  /// Creates the temporary file. The mode is that of the file that it replaces, else as umask says.
  /// Throws Error(run_time) with the path and the reason if there is no folder, if no file can be
  /// written, or if anything but a regular file exists there.
  explicit OutputFile(const std::filesystem::path& path, Links links = Links::follow);
  ~OutputFile();  ///< removes the temporary file unless commit() renamed it
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }

  /// These throw Error(run_time) with the reason, for example a full disk.
  void write(std::span<const std::byte> bytes);
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

/// Checks before long work that `path` can be written: its folder exists and accepts a new file,
/// and any existing file is regular and writable. Leaves no file behind. Throws Error(run_time)
/// with the path and the reason.
void check_writable(const std::filesystem::path& path);

/// A file and the option that names it, for errors. An empty path means that the option is not
/// given.
struct NamedFile {
  std::string option;
  std::filesystem::path path;
};

/// check_writable() of all outputs. Throws Error(usage) if two outputs, or an output and an input,
/// are one file.
void check_outputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

/// Writes `bytes` to `path` as an OutputFile. On failure (for example a full disk) leaves `path`
/// unchanged and throws Error(run_time) with the reason.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace clpv
