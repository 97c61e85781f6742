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
#include "support/progress.hpp"

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
  std::size_t items = 0;  ///< work-items of the largest launch
  std::size_t chain = 0;  ///< longest Chain of a launch
  double ms = 0;          ///< sum of the launches [ms]
};

/// Largest number of elements that a work-item of a launch takes one after the other, such as
/// triangles of a tile, texels, rays or planes; 0 where the host does not know it.
enum class Chain : std::size_t {};

/// Work of the host for a frame.
struct HostWork {
  unsigned launches = 0;    ///< kernels, fills and copies
  unsigned fills = 0;       ///< launches that fill or copy
  unsigned waits = 0;       ///< times that the host waited for the device
  unsigned arguments = 0;   ///< arguments of kernels, set because they had changed
  std::size_t written = 0;  ///< to buffers [bytes]
  double waited_ms = 0;     ///< sum of the waits [ms]
  double host_ms = 0;       ///< from clear() to enqueued(), waits not included [ms]
  /// Parts of host_ms [ms]: finding the triangle clusters of views, setting arguments, and OpenCL's
  /// calls that enqueue a launch.
  double culling_ms = 0, arguments_ms = 0, enqueueing_ms = 0;
};

/// Adds the time of its scope to a part of HostWork.
class HostPart {
 public:
  explicit HostPart(double& ms) : ms_(ms), start_(std::chrono::steady_clock::now()) {}
  ~HostPart() { ms_ += ms_since(start_); }
  HostPart(const HostPart&) = delete;
  HostPart& operator=(const HostPart&) = delete;

 private:
  double& ms_;
  std::chrono::steady_clock::time_point start_;
};

/// Start and end of an event that is complete, on the device's clock [ns]. `valid`: the device
/// says them, and the end is not before the start.
struct EventTimes {
  cl_ulong start = 0, end = 0;
  bool valid = false;
  double ms() const { return static_cast<double>(end - start) * 1e-6; }
};
EventTimes times_of(const cl::Event& event);

/// Clocks of device and host differ by less: resolution of the device's, adjustment of the host's.
inline constexpr double kClockTolerance = 0.1;

/// Events may not take less than this share of what the host waited for them: gaps between launches
/// take the rest (seen: 0.97 on PoCL, busy or not). Shorter waits than kLeastWaitMs are no
/// evidence: a busy host takes as long to wake up.
inline constexpr double kLeastShareOfWait = 0.25, kLeastWaitMs = 50;

/// Collects the events of launches, by stage, and counts launches and waits.
class Timeline {
 public:
  /// `events_valid`: true if profiling events report plausible times (Device::profiling_valid).
  /// `waits`: the queue has no work of others; if events are invalid, end() waits for it and
  /// measures wall time. False: those times are 0.
  explicit Timeline(bool events_valid, bool waits = true)
      : events_valid_(events_valid), waits_(waits) {}

  void begin(StageMark mark);  ///< starts a stage; times of repeated stages add up
  void end(cl::CommandQueue& queue);
  void abandon();  ///< ends a stage that failed, without its time
  /// Counts a launch and calls `enqueue` with a pointer to its event, which it adds to the current
  /// stage, or null if it needs none. No kernel: a fill or a copy.
  template <typename Enqueue>
  void enqueue(const Enqueue& enqueue, const cl::Kernel& kernel = {}, std::size_t items = 0,
               Chain chain = {}) {
    Launch launch{{}, kernel, items, chain};
    {
      const HostPart part(host_.enqueueing_ms);
      enqueue(events_valid_ ? &launch.event : nullptr);
    }
    add(std::move(launch));
  }
  /// If true, launches find their Chain even if they have to wait for it.
  bool counts_chains() const { return counts_chains_; }
  void count_chains(bool counts) { counts_chains_ = counts; }
  /// Calls `wait`, which waits for the device, and counts it. `compiles`: the device may also
  /// compile meanwhile.
  template <typename Wait>
  void wait(const Wait& wait, bool compiles = false) {
    const Clock::time_point start = Clock::now();
    named_errors(wait);
    ++host_.waits;
    host_.waited_ms += ms_since(start);
    if (!compiles) worked_ms_ += ms_since(start);
  }
  /// Waits until the queue's work is done, which ends a frame.
  void finish(cl::CommandQueue& queue) {
    wait([&] { queue.finish(); });
  }
  /// Waits for the events; one entry per stage, in order of first begin. Events that end before
  /// they start, or together take no time, longer than the host's since clear(), or far less than
  /// the host waited, are a warning: there are no entries then, and stages have wall times from the
  /// next clear() on.
  std::vector<StageTime> times();
  bool events_valid() const { return events_valid_; }
  /// As times(). One entry per stage and kernel, in order of first launch; none without valid
  /// events.
  std::vector<KernelTime> kernel_times();
  void clear();                                   ///< begins a frame
  void enqueued();                                ///< ends the host's part of a frame
  const HostWork& host() const { return host_; }  ///< since clear()
  HostWork& host() { return host_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Launch {
    cl::Event event;
    cl::Kernel kernel;
    std::size_t items;
    Chain chain;
  };
  void add(Launch launch);
  struct Entry {
    StageMark mark;
    std::vector<Launch> launches;
    double wall_ms = 0;
  };
  bool events_valid_, waits_, counts_chains_ = false;
  double worked_ms_ = 0;  ///< that the host waited while the device only worked, since clear()
  HostWork host_;
  int current_ = -1;
  std::vector<Entry> entries_;
  Clock::time_point started_, cleared_;
};

}  // namespace clpv
