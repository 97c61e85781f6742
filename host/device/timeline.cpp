// SPDX-License-Identifier: MIT
#include "device/timeline.hpp"

#include <algorithm>

#include "support/log.hpp"

namespace clpv {

EventTimes times_of(const cl::Event& event) {
  EventTimes times;
  const auto get = [&](cl_profiling_info what, cl_ulong& value) {
    return clGetEventProfilingInfo(event(), what, sizeof value, &value, nullptr) == CL_SUCCESS;
  };
  times.valid = get(CL_PROFILING_COMMAND_START, times.start) &&
                get(CL_PROFILING_COMMAND_END, times.end) && times.start <= times.end;
  return times;
}

void Timeline::begin(StageMark mark) {
  const auto found = std::ranges::find(entries_, mark, &Entry::mark);
  current_ = found - entries_.begin();
  if (found == entries_.end()) entries_.push_back({std::move(mark), {}, 0});
  started_ = Clock::now();
}

void Timeline::end(cl::CommandQueue& queue) {
  if (current_ < 0) return;
  if (!events_valid_ && waits_) {
    wait([&] { queue.finish(); });
    entries_[current_].wall_ms += ms_since(started_);
  }
  current_ = -1;
}

void Timeline::abandon() {
  current_ = -1;
}

void Timeline::add(Launch launch) {
  ++host_.launches;
  if (launch.kernel() == nullptr) ++host_.fills;
  if (current_ >= 0 && events_valid_) entries_[current_].launches.push_back(std::move(launch));
}

std::vector<StageTime> Timeline::times() {
  std::vector<StageTime> result;
  double sum = 0;
  bool plausible = true, launched = false;
  for (const Entry& entry : entries_) {
    StageTime time{entry.mark, entry.wall_ms, events_valid_};
    for (const Launch& launch : entry.launches) {
      launch.event.wait();
      const EventTimes found = times_of(launch.event);
      plausible = plausible && found.valid, launched = true;
      time.ms += found.ms(), sum += found.ms();
    }
    result.push_back(std::move(time));
  }
  const bool still = launched && sum == 0;
  const bool is_short =
      waits_ && launched && worked_ms_ >= kLeastWaitMs && sum < worked_ms_ * kLeastShareOfWait;
  const bool is_long = sum > ms_since(cleared_) * (1 + kClockTolerance);
  if (!events_valid_ || (plausible && !still && !is_short && !is_long)) return result;
  log_warning("the device's events {}: times of stages are the host's from here on",
              !plausible ? "end before they start"
              : still    ? "take no time"
              : is_short ? "take far less time than the host waits for them"
                         : "take longer than the host waits for them");
  events_valid_ = false;
  entries_.clear();
  return {};
}

std::vector<KernelTime> Timeline::kernel_times() {
  static_cast<void>(times());  // drops events that are not plausible
  std::vector<KernelTime> result;
  for (const Entry& entry : entries_) {
    const auto stage = static_cast<std::ptrdiff_t>(result.size());
    for (const Launch& launch : entry.launches) {
      const std::string name = launch.kernel() != nullptr
                                   ? launch.kernel.getInfo<CL_KERNEL_FUNCTION_NAME>()
                                   : "fill and copy";
      auto found = std::find_if(result.begin() + stage, result.end(),
                                [&](const KernelTime& time) { return time.kernel == name; });
      if (found == result.end()) found = result.insert(found, {entry.mark, name});
      ++found->launches;
      found->items = std::max(found->items, launch.items);
      found->chain = std::max(found->chain, static_cast<std::size_t>(launch.chain));
      found->ms += times_of(launch.event).ms();
    }
  }
  return result;
}

void Timeline::clear() {
  entries_.clear();
  host_ = {};
  worked_ms_ = 0;
  current_ = -1;
  cleared_ = Clock::now();
}

void Timeline::enqueued() {
  host_.host_ms = ms_since(cleared_) - host_.waited_ms;
}

}  // namespace clpv
