// SPDX-License-Identifier: MIT
#include "cli/video.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <iterator>
#include <sstream>

#include "image/image.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

// Players need even sizes and 4:2:0 chroma; x264's loss is hardly visible at CRF 18.
constexpr const char* kEncoding =
    "-vf pad=ceil(iw/2)*2:ceil(ih/2)*2 -c:v libx264 -crf 18 -pix_fmt yuv420p -movflags +faststart "
    "-f mp4 -y";

std::vector<std::uint8_t> rgb_bytes(const Image& shown) {
  const std::size_t channels = shown.channels.size();
  std::vector<std::uint8_t> bytes(3 * shown.pixel_count());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = byte_of(shown.pixels[i / 3 * channels + i % 3]);
  return bytes;
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

Video::Video(fs::path file, double frames_per_second)
    : file_(std::move(file)), frames_per_second_(frames_per_second) {
  const auto found = find_program("ffmpeg");
  if (!found)
    throw Error(ExitCode::run_time, "--video needs ffmpeg, which is not in PATH (Debian: ffmpeg)");
  ffmpeg_ = *found;
}

Video::~Video() {
  process_.reset();  // before part_, which it writes
}

void Video::fail(const Process::Result& ended) const {
  stop_if_interrupted(fmt::format("{} was not written", file_.string()));
  throw Error(ExitCode::run_time, "{}: {} ended with {}: {}", file_.string(), ffmpeg_.string(),
              ended.code, ended.output);
}

void Video::add(const Image& shown) {
  if (!process_) {
    std::vector<std::string> words =
        words_of(fmt::format("-hide_banner -loglevel error -f rawvideo -pixel_format rgb24 "
                             "-video_size {}x{} -framerate {} -i pipe:0 {}",
                             shown.width, shown.height, frames_per_second_, kEncoding));
    part_.emplace(file_);
    words.push_back("file:" +
                    part_->temporary().string());  // a name with a colon would be a protocol
    process_ = std::make_unique<Process>(ffmpeg_, words, true);
  }
  const std::vector<std::uint8_t> bytes = rgb_bytes(shown);
  if (!process_->feed(std::as_bytes(std::span(bytes)))) fail(process_->end());
}

void Video::finish() {
  const Process::Result ended = process_->end();
  process_.reset();
  if (ended.code != 0) fail(ended);
  part_->commit();
}

}  // namespace clpv
