// SPDX-License-Identifier: MIT
// Times of frames, and the loop that measures them.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "device/timeline.hpp"
#include "pipeline/frame/frame.hpp"

namespace clpv {

/// Cost of a frame on the host's clock.
struct FrameCost {
  double wall_ms = 0;  ///< from its first command to the end of its last one
  HostWork host = {};  ///< to enqueue it
};

/// Times [ms] of frames: of their stages on the device, and of whole frames on the host's clock.
class FrameTimes {
 public:
  void add(std::vector<StageTime> stages, const FrameCost& cost = {});
  std::size_t count() const { return frames_.size(); }

  const std::vector<FrameCost>& costs() const { return costs_; }
  /// Sums over the stages for which `counts` returns true, one per frame; null: all stages.
  std::vector<double> sums(const std::function<bool(const StageMark&)>& counts = {}) const;

  /// Times of a stage of one cascade and light, one per frame; 0 in frames that did not run it.
  struct Series {
    StageMark mark;
    bool from_events;
    std::vector<double> ms = {};
  };
  /// One series per stage, cascade and light, in order of first occurrence.
  std::vector<Series> stages() const;
  /// Series by pass: sums over cascades and lights.
  std::map<std::string, std::vector<double>> passes() const;
  /// Medians of passes().
  std::map<std::string, double> pass_medians() const;
  /// True if the times of all stages are from device events.
  bool from_events() const;

 private:
  std::vector<std::vector<StageTime>> frames_;
  std::vector<FrameCost> costs_;
};

/// Renders `frames` frames that recompute all lighting, after `warm_up` others, and waits for each.
/// `after`, if not null, is called after each frame, before its times are read: launches in it
/// count.
FrameTimes measure_frames(Session& session, Frame& frame, const SceneCamera& camera, int frames,
                          int warm_up, const std::function<void()>& after = {});

/// A list of {stage, cascade, light, ms, timer}.
nlohmann::json to_json(const std::vector<StageTime>& times);
/// Throws nlohmann::json::exception or Error(usage) if the JSON is no such list.
std::vector<StageTime> stage_times_from_json(const nlohmann::json& json);

}  // namespace clpv
