// SPDX-License-Identifier: MIT
// Device time of each stage.
#pragma once

#include <CL/opencl.hpp>
#include <chrono>
#include <optional>
#include <vector>

#include "options/stages.hpp"

namespace clpv {

/// Stage that a launch belongs to. `cascade` counts from 0 (finest); `light` indexes SceneData::lights.
struct StageMark {
  Pass pass;
  std::optional<int> cascade = std::nullopt;
  std::optional<int> light = std::nullopt;
  bool operator==(const StageMark&) const = default;
};

/// Total device time of one stage [ms].
struct StageTime {
  StageMark mark;
  double ms = 0;
  bool from_events = true;  ///< false: wall time, since the device's events are implausible
};

/// Collects the events of launches, by stage.
class Timeline {
 public:
  /// `events_valid`: true if profiling events report plausible times (Device::profiling_valid). `waits`: without them, end() waits
  /// for the queue to measure wall time; else times are 0.
  explicit Timeline(bool events_valid, bool waits = true) : events_valid_(events_valid), waits_(waits) {}

  void begin(StageMark mark);         ///< starts a stage; times of repeated stages add up
  void end(cl::CommandQueue& queue);
  void add(const cl::Event& event);   ///< adds an event to the current stage
  std::vector<StageTime> times()
      const;  ///< waits for the events; one entry per stage, in order of first begin
  void clear();

 private:
  struct Entry {
    StageMark mark;
    std::vector<cl::Event> events;
    double wall_ms = 0;
  };
  bool events_valid_, waits_;
  int current_ = -1;
  std::vector<Entry> entries_;
  std::chrono::steady_clock::time_point started_;
};

}  // namespace clpv
