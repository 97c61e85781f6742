// SPDX-License-Identifier: MIT
// Device time of each stage, and what the host did for it.
#pragma once

#include <CL/opencl.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "device/cl_error.hpp"
#include "options/stages.hpp"

namespace clpv {

/// Stage that a launch belongs to. `cascade` counts from 0 (finest); `light` indexes
/// SceneData::lights.
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

/// Device time of one kernel in one stage.
struct KernelTime {
  StageMark mark;
  std::string kernel;  ///< its function, or "fill and copy"
  unsigned launches = 0;
  double ms = 0;  ///< sum of the launches [ms]
};

/// Work of the host for a frame.
struct HostWork {
  unsigned launches = 0;  ///< kernels, fills and copies
  unsigned waits = 0;     ///< times that the host waited for the device
  double waited_ms = 0;   ///< sum of the waits [ms]
  double host_ms = 0;     ///< from clear() to enqueued(), waits not included [ms]
};

/// Collects the events of launches, by stage, and counts launches and waits.
class Timeline {
 public:
  /// `events_valid`: true if profiling events report plausible times (Device::profiling_valid).
  /// `waits`: without them, end() waits for the queue to measure wall time; else times are 0.
  explicit Timeline(bool events_valid, bool waits = true)
      : events_valid_(events_valid), waits_(waits) {}

  void begin(StageMark mark);  ///< starts a stage; times of repeated stages add up
  void end(cl::CommandQueue& queue);
  void abandon();  ///< ends a stage that failed, without its time
  /// Counts a launch, whose event it adds to the current stage. No kernel: a fill or a copy.
  void add(const cl::Event& event, const cl::Kernel& kernel = {});
  /// Calls `wait`, which waits for the device, and counts it.
  template <typename Wait>
  void wait(const Wait& wait) {
    const Clock::time_point start = Clock::now();
    named_errors(wait);
    ++host_.waits;
    host_.waited_ms += since(start);
  }
  std::vector<StageTime> times()
      const;  ///< waits for the events; one entry per stage, in order of first begin
  /// Waits for the events. One entry per stage and kernel, in order of first launch; none without
  /// valid events.
  std::vector<KernelTime> kernel_times() const;
  void clear();                                   ///< begins a frame
  void enqueued();                                ///< ends the host's part of a frame
  const HostWork& host() const { return host_; }  ///< since clear()

 private:
  using Clock = std::chrono::steady_clock;
  static double since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }
  struct Launch {
    cl::Event event;
    cl::Kernel kernel;
    double ms() const;  ///< waits for the event
  };
  struct Entry {
    StageMark mark;
    std::vector<Launch> launches;
    double wall_ms = 0;
  };
  bool events_valid_, waits_;
  HostWork host_;
  int current_ = -1;
  std::vector<Entry> entries_;
  Clock::time_point started_, cleared_;
};

}  // namespace clpv
