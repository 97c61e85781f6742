// SPDX-License-Identifier: MIT
// A temporary folder, which disappears with the process that made it.
#pragma once

#include <filesystem>

namespace clpv {

/// A new folder clpv-XXXXXX in $TMPDIR, or /tmp, that only this user can read.
class ScratchFolder {
 public:
  /// Also removes the folders that killed runs of this user left there. Throws Error(run_time) that
  /// names TMPDIR if the folder cannot be made.
  ScratchFolder();
  ~ScratchFolder();  ///< removes it with all it holds
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;  ///< the locked folder: the lock ends with the process
};

}  // namespace clpv
