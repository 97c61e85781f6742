// SPDX-License-Identifier: MIT
#include "times/frame_times.hpp"

#include <algorithm>
#include <chrono>

#include "support/interrupt.hpp"

namespace clpv {

void FrameTimes::add(const std::vector<StageTime>& stages, const FrameCost& cost) {
  for (Series& series : series_) series.ms.push_back(0);
  costs_.push_back(cost);
  for (const StageTime& time : stages) {
    auto found = std::ranges::find(series_, time.mark, &Series::mark);
    if (found == series_.end())
      found = series_.insert(found, {time.mark, std::vector<double>(count(), 0.0)});
    found->ms.back() += time.ms;
    from_events_ = from_events_ && time.from_events;
  }
}

std::vector<double> FrameTimes::sums(const std::function<bool(const StageMark&)>& counts) const {
  std::vector<double> sums(count(), 0.0);
  for (const Series& series : series_) {
    if (counts && !counts(series.mark)) continue;
    for (std::size_t frame = 0; frame < count(); ++frame) sums[frame] += series.ms[frame];
  }
  return sums;
}

std::map<std::string, std::vector<double>> FrameTimes::passes() const {
  std::map<std::string, std::vector<double>> all;
  for (const Series& series : series_) {
    const Pass pass = series.mark.pass;
    all[std::string(name_of(pass))] =
        sums([&](const StageMark& mark) { return mark.pass == pass; });
  }
  return all;
}

std::vector<TimeRecord> FrameTimes::stage_records() const {
  std::vector<TimeRecord> records;
  for (const Series& series : series_) records.push_back(time_record(series.mark, series.ms));
  return records;
}

std::vector<TimeRecord> FrameTimes::pass_records() const {
  std::vector<TimeRecord> records;
  for (const auto& [pass, ms] : passes()) records.push_back(time_record(pass, ms));
  return records;
}

FrameTimes measure_frames(Session& session, Frame& frame, const SceneCamera& camera, int frames,
                          int warm_up, const std::function<void()>& after) {
  using Clock = std::chrono::steady_clock;
  FrameTimes times;
  for (int i = -warm_up; i < frames; ++i) {
    stop_if_interrupted();
    frame.invalidate_light();
    const Clock::time_point start = Clock::now();
    frame.render(camera);
    const HostWork host = session.timeline().host();
    session.timeline().finish(session.queue());
    const double wall_ms = ms_since(start);
    if (after) after();
    const bool events = session.timeline().events_valid();
    const std::vector<StageTime> stages = session.timeline().times();
    if (events != session.timeline().events_valid()) {
      times = {}, i = -warm_up - 1;  // all again, by one clock
    } else if (i >= 0) {
      times.add(stages, {wall_ms, host});
    }
  }
  times.set_kernels(session.timeline().kernel_times());
  return times;
}

void count_chains(Session& session, Frame& frame, const SceneCamera& camera, FrameTimes& times) {
  session.timeline().count_chains(true);
  frame.invalidate_light();
  frame.render(camera);
  session.timeline().count_chains(false);
  times.set_kernels(session.timeline().kernel_times());
}

}  // namespace clpv
