// SPDX-License-Identifier: MIT
// How long the frames of a sequence took, each and together.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "device/timeline.hpp"

namespace clpv {

/// Of one frame [ms], wall times.
struct FrameTimes {
  double pose_ms = 0;   ///< the scene brought to its instant, on host and device
  double frame_ms = 0;  ///< all stages, until the device is done
  double write_ms = 0;  ///< read back, encoded and written
  bool first = false;   ///< of a run: its launches may compile
  std::vector<StageTime> stages;
};

class SequenceTimes {
 public:
  SequenceTimes();
  ~SequenceTimes();

  /// Takes over what a file of to_json() tells of those frames, where there is one and it does.
  void keep(const std::filesystem::path& file, const std::vector<int>& frames);
  /// What to_json() of another rank tells.
  void merge(const nlohmann::json& told);

  void add(int frame, double seconds, const FrameTimes& times);

  /// Schema 1: all that `about` has, frames, and a summary of all but first ones: median, 95th percentile and worst of
  /// pose_ms, frame_ms, write_ms and each stage, cascade and light; a frame that did without a stage took 0 ms for it.
  nlohmann::json to_json(const nlohmann::json& about) const;

 private:
  std::map<int, nlohmann::json> frames_;
};

}  // namespace clpv
