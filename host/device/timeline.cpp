// SPDX-License-Identifier: MIT
#include "device/timeline.hpp"

#include <algorithm>

namespace clpv {

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
    entries_[current_].wall_ms += since(started_);
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

double Timeline::Launch::ms() const {
  event.wait();
  const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
  return static_cast<double>(end - start) * 1e-6;
}

std::vector<StageTime> Timeline::times() const {
  std::vector<StageTime> result;
  for (const Entry& entry : entries_) {
    StageTime time{entry.mark, entry.wall_ms, events_valid_};
    for (const Launch& launch : entry.launches) time.ms += launch.ms();
    result.push_back(std::move(time));
  }
  return result;
}

std::vector<KernelTime> Timeline::kernel_times() const {
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
      found->ms += launch.ms();
    }
  }
  return result;
}

void Timeline::clear() {
  entries_.clear();
  host_ = {};
  current_ = -1;
  cleared_ = Clock::now();
}

void Timeline::enqueued() {
  host_.host_ms = since(cleared_) - host_.waited_ms;
}

}  // namespace clpv
