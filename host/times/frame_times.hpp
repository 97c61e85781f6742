// SPDX-License-Identifier: MIT
// Times of frames, and the loop that measures them.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "device/timeline.hpp"
#include "pipeline/frame/frame.hpp"
#include "times/time_record.hpp"

namespace clpv {

/// Cost of a frame on the host's clock.
struct FrameCost {
  double wall_ms = 0;  ///< from its first command to the end of its last one
  HostWork host = {};  ///< to enqueue it
};

/// Times [ms] of frames: of their stages on the device, and of whole frames on the host's clock.
class FrameTimes {
 public:
  void add(const std::vector<StageTime>& stages, const FrameCost& cost = {});
  void set_kernels(std::vector<KernelTime> times) { kernels_ = std::move(times); }
  const std::vector<KernelTime>& kernels() const { return kernels_; }  ///< kernels of one frame
  std::size_t count() const { return costs_.size(); }

  const std::vector<FrameCost>& costs() const { return costs_; }
  /// Sums over the stages for which `counts` returns true, one per frame; null: all stages.
  std::vector<double> sums(const std::function<bool(const StageMark&)>& counts = {}) const;
  /// Samples by pass, one per frame: sums over cascades and lights.
  std::map<std::string, std::vector<double>> passes() const;
  /// One record per stage, cascade and light, in order of first occurrence.
  std::vector<TimeRecord> stage_records() const;
  /// One record per pass, by name.
  std::vector<TimeRecord> pass_records() const;
  /// True if the times of all stages are from device events.
  bool from_events() const { return from_events_; }

 private:
  struct Series {
    StageMark mark;
    std::vector<double> ms;  ///< one per frame; 0 in frames that did not run it
  };
  std::vector<Series> series_;
  std::vector<FrameCost> costs_;
  std::vector<KernelTime> kernels_;
  bool from_events_ = true;
};

/// Renders `frames` frames that recompute all lighting, after `warm_up` others, and waits for each.
/// `after`, if not null, is called after each frame, before its times are read: launches in it
/// count.
FrameTimes measure_frames(Session& session, Frame& frame, const SceneCamera& camera, int frames,
                          int warm_up, const std::function<void()>& after = {});

/// Renders one more of those frames, whose kernels become those of `times`. It waits for numbers
/// that only the device knows: KernelTime::chain.
void count_chains(Session& session, Frame& frame, const SceneCamera& camera, FrameTimes& times);

}  // namespace clpv
