// SPDX-License-Identifier: MIT
// Encodes frames into a video with ffmpeg.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "image/image.hpp"
#include "support/output_file.hpp"
#include "support/process.hpp"

namespace clpv {

/// H.264 video in an MP4 file, an OutputFile.
class Video {
 public:
  /// Throws Error(run_time) if ffmpeg is not in the path (with what to install). Construct before
  /// the work.
  Video(std::filesystem::path file, double frames_per_second);
  ~Video();  ///< without finish(): no video
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  /// Adds a frame: display-encoded RGB or RGBA, of the size of earlier frames. This and finish()
  /// throw Error(run_time) with ffmpeg's message on failure.
  void add(const Image& shown);
  void finish();

 private:
  [[noreturn]] void fail(const Process::Result& ended) const;

  std::filesystem::path file_, ffmpeg_;
  double frames_per_second_;
  std::optional<OutputFile> part_;
  std::unique_ptr<Process> process_;
};

}  // namespace clpv
