// SPDX-License-Identifier: MIT
// Frames into a film, through ffmpeg.
#pragma once

#include <filesystem>
#include <memory>

#include "image/image.hpp"
#include "support/process.hpp"

namespace clpv {

/// H.264 in an MP4. Written beside its place, and there once it is whole.
class Video {
 public:
  /// Throws Error(run_time) that says what to install where there is no ffmpeg in the path, and where `file` cannot be
  /// written. To be made before the work.
  Video(std::filesystem::path file, double frames_per_second);
  ~Video();  ///< without finish(): no film
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  /// One more frame: display-encoded R, G, B and perhaps A, of the size of those before. Throws Error(run_time) with
  /// ffmpeg's words where it fails; so does finish().
  void add(const Image& shown);
  void finish();

 private:
  [[noreturn]] void fail(const Process::Result& ended) const;

  std::filesystem::path file_, part_;
  double frames_per_second_;
  std::unique_ptr<Process> process_;
};

}  // namespace clpv
