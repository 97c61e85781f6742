// SPDX-License-Identifier: MIT
// A temporary folder, which disappears with the process that made it.
#pragma once

#include <filesystem>

namespace clpv {

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
