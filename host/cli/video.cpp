// SPDX-License-Identifier: MIT
#include "cli/video.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <sstream>

#include "support/error.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFfmpeg = "ffmpeg";
// Players need even sizes and 4:2:0 chroma; x264's loss is hardly visible at CRF 18.
constexpr const char* kEncoding =
    "-vf pad=ceil(iw/2)*2:ceil(ih/2)*2 -c:v libx264 -crf 18 -pix_fmt yuv420p -movflags +faststart -f mp4 -y";

std::vector<std::uint8_t> rgb_bytes(const Image& shown) {
  const std::size_t channels = shown.channels.size();
  std::vector<std::uint8_t> bytes(3 * shown.pixel_count());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const float value = shown.pixels[i / 3 * channels + i % 3];
    bytes[i] = static_cast<std::uint8_t>(std::lround(255 * (value > 0 ? std::min(value, 1.0f) : 0.0f)));
  }
  return bytes;
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

Video::Video(fs::path file, double frames_per_second)
    : file_(std::move(file)), frames_per_second_(frames_per_second) {
  if (Process(kFfmpeg, {"-version"}).end().code < 0)
    throw Error(ExitCode::run_time, "--video needs ffmpeg, which is not in PATH (Debian: ffmpeg)");
  check_writable(file_);
  part_ = file_.parent_path() / fmt::format(".{}.{}.part", file_.filename().string(), ::getpid());
}

Video::~Video() {
  process_.reset();
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void Video::fail(const Process::Result& ended) const {
  throw Error(ExitCode::run_time, "{}: {} ended with {}: {}", file_.string(), kFfmpeg, ended.code,
              ended.output);
}

void Video::add(const Image& shown) {
  if (!process_) {
    std::vector<std::string> words =
        words_of(fmt::format("-hide_banner -loglevel error -f rawvideo -pixel_format rgb24 -video_size {}x{} "
                             "-framerate {} -i pipe:0 {}",
                             shown.width, shown.height, frames_per_second_, kEncoding));
    words.push_back(part_.string());
    process_ = std::make_unique<Process>(kFfmpeg, words, true);
  }
  const std::vector<std::uint8_t> bytes = rgb_bytes(shown);
  if (!process_->feed(std::as_bytes(std::span(bytes)))) fail(process_->end());
}

void Video::finish() {
  const Process::Result ended = process_->end();
  process_.reset();
  if (ended.code != 0) fail(ended);
  std::error_code failed;
  fs::rename(part_, file_, failed);
  if (failed) throw Error(ExitCode::run_time, "{}: cannot be written: {}", file_.string(), failed.message());
}

}  // namespace clpv
