// SPDX-License-Identifier: MIT
// A temporary folder, which disappears with the process that made it.
#pragma once

#include <filesystem>

namespace clpv {

/// A new folder run-XXXXXX in $TMPDIR/.clpv-scratch-UID, or below /tmp, that only this user can
/// read. Its file `clpv-scratch`, locked until the process ends, marks it as clpv's.
class ScratchFolder {
 public:
  /// Also removes the marked folders of killed runs, and nothing else: if anyone but this user may
  /// have written .clpv-scratch-UID, warns and makes the folder beside it. Throws Error(run_time)
  /// that names TMPDIR if the folder cannot be made.
  ScratchFolder();
  ~ScratchFolder();  ///< removes it with all it holds
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;  ///< of the mark
};

}  // namespace clpv
