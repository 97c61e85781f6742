// SPDX-License-Identifier: MIT
// When each stage ran on the device, and for how long.
#pragma once

#include <CL/opencl.hpp>
#include <chrono>
#include <optional>
#include <vector>

#include "options/stages.hpp"

namespace clpv {

/// What a launch belongs to. `cascade` counts from 0 (finest); `light` indexes Scene::lights.
struct StageMark {
  Pass pass;
  std::optional<int> cascade = std::nullopt;
  std::optional<int> light = std::nullopt;
  bool operator==(const StageMark&) const = default;
};

struct StageTime {
  StageMark mark;
  double ms = 0;
  bool from_events = true;  ///< false: wall time, where the device's events are implausible
};

/// Collects the events of launches under the mark in force.
class Timeline {
 public:
  /// `events_valid`: whether the device's profiling events tell plausible times (Device::profiling_valid).
  explicit Timeline(bool events_valid) : events_valid_(events_valid) {}

  void begin(StageMark mark);            ///< starts a stage; a stage may be begun again, its times add up
  void end(cl::CommandQueue& queue);     ///< without valid events, waits for the queue to take the wall time
  void add(const cl::Event& event);      ///< an event of the stage begun last
  std::vector<StageTime> times() const;  ///< waits for the events; one entry a mark, in order of first begin
  void clear();

 private:
  struct Entry {
    StageMark mark;
    std::vector<cl::Event> events;
    double wall_ms = 0;
  };
  bool events_valid_;
  int current_ = -1;
  std::vector<Entry> entries_;
  std::chrono::steady_clock::time_point started_;
};

}  // namespace clpv
