// SPDX-License-Identifier: MIT
// Atomic file output: a temporary file in the same folder, renamed into place. The only way to an
// output: it spares inputs and keeps modes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/input_file.hpp"

namespace clpv {

/// A file under a temporary name in the folder of its target. Readers see the old or the new
/// target, never a partial one.
class OutputFile {
 public:
  enum class Kind {
    result,   ///< a symbolic link is kept, and its target replaced; survives a crash of the machine
    derived,  ///< a result of a name that clpv makes: a symbolic link is rejected
    entry     ///< in a cache or temporary folder: replaces whatever has the name
  };

  /// Creates the temporary file. A result keeps the mode of the file that it replaces. Throws
  /// Error(run_time) with the path and the reason if there is no folder, if no file can be written
  /// there, or if anything but a regular file exists there; Error(usage) for a file of the
  /// InputRecord.
  explicit OutputFile(const std::filesystem::path& path, Kind kind = Kind::result);
  ~OutputFile();  ///< removes the temporary file unless commit() renamed it
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }

  /// These throw Error(run_time) with the reason, for example a full disk. commit() also throws
  /// Error(usage) if the target has become an input.
  void write(std::span<const std::byte> bytes);
  void commit();

 private:
  void create(mode_t mode);
  void discard();

  std::filesystem::path target_, temporary_;
  Kind kind_;
  int descriptor_ = -1;
};

/// Removes the temporary files of all unfinished outputs, before a signal ends the process. May be
/// called by a signal handler.
void remove_unfinished_outputs();

/// Checks before long work that `path` can be written, as OutputFile and its commit() will. Leaves
/// no file behind. Throws as OutputFile.
void check_writable(const std::filesystem::path& path,
                    OutputFile::Kind kind = OutputFile::Kind::result);

/// check_writable() of all outputs. Throws Error(usage) if two outputs, or an output and an input
/// of `inputs` or the InputRecord, are one file. Commands call it before they read anything, and
/// again before long work, when all inputs are read.
void check_outputs(const std::vector<NamedFile>& outputs,
                   const std::vector<NamedFile>& inputs = {});

/// Writes `bytes` to `path` as an OutputFile. On failure (for example a full disk) leaves `path`
/// unchanged and throws Error(run_time) with the reason.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes,
                OutputFile::Kind kind = OutputFile::Kind::result);
void write_file(const std::filesystem::path& path, std::string_view text,
                OutputFile::Kind kind = OutputFile::Kind::result);

}  // namespace clpv
