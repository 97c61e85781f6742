// SPDX-License-Identifier: MIT
// times.jsonl: times of the frames in a folder, as JSON lines that any number of processes append.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/timeline.hpp"

namespace clpv {

/// Wall times of a frame [ms], and its stages. pose: scene animation on host and device. frame: all
/// stages, until the device has finished. write: readback, encoding and writing.
struct FrameLine {
  int frame = 0;         ///< number
  std::string key;       ///< key of the frame's pixels, as in its file
  std::string settings;  ///< key of what all frames and times of a run share
  double seconds = 0;    ///< time of the scene
  bool first = false;    ///< first frame of a process, whose launches may compile kernels
  double pose_ms = 0, frame_ms = 0, write_ms = 0;
  std::vector<StageTime> stages;  ///< none of a first frame
};

nlohmann::json to_json(const FrameLine& line);
/// Returns nothing if the text is not such a line, with numbers in their ranges.
std::optional<FrameLine> frame_line(const std::string& text);

/// The file. Its first line identifies it; all others are independent.
class TimesFile {
 public:
  /// Creates the file if it is missing or empty. Throws Error(run_time) for a file that clpv did
  /// not write, which stays as it is, and for one that cannot be opened.
  explicit TimesFile(std::filesystem::path path);
  ~TimesFile();
  TimesFile(const TimesFile&) = delete;
  TimesFile& operator=(const TimesFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Appends a line with one write; processes do not mix theirs. Throws Error(run_time), for
  /// example for a full disk, and leaves the file as it was.
  void append(const nlohmann::json& line);

  /// Reads the last line of each frame from 0 to `keys.size()` - 1 that has the frame's key and
  /// these settings, and calls `action` for them in order. Other lines, for example a torn one, are
  /// skipped. Memory: 8 bytes for each frame, and one line.
  void read(const std::vector<std::string>& keys, const std::string& settings,
            const std::function<void(const FrameLine&)>& action) const;

 private:
  void begin();
  void append_text(std::string text);

  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace clpv
