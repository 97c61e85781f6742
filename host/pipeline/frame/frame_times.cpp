// SPDX-License-Identifier: MIT
#include "pipeline/frame/frame_times.hpp"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "support/interrupt.hpp"
#include "support/json_optional.hpp"
#include "support/statistics.hpp"

namespace clpv {

void FrameTimes::add(std::vector<StageTime> stages, const FrameCost& cost) {
  frames_.push_back(std::move(stages));
  costs_.push_back(cost);
}

std::vector<double> FrameTimes::sums(const std::function<bool(const StageMark&)>& counts) const {
  std::vector<double> sums(frames_.size(), 0.0);
  for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
    for (const StageTime& time : frames_[frame])
      if (!counts || counts(time.mark)) sums[frame] += time.ms;
  }
  return sums;
}

std::vector<FrameTimes::Series> FrameTimes::stages() const {
  std::vector<Series> all;
  for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
    for (const StageTime& time : frames_[frame]) {
      auto found = std::ranges::find(all, time.mark, &Series::mark);
      if (found == all.end())
        found = all.insert(found,
                           {time.mark, time.from_events, std::vector<double>(frames_.size(), 0.0)});
      found->ms[frame] += time.ms;
    }
  }
  return all;
}

std::map<std::string, std::vector<double>> FrameTimes::passes() const {
  std::map<std::string, std::vector<double>> all;
  for (const Series& series : stages()) {
    std::vector<double>& sums = all[std::string(name_of(series.mark.pass))];
    sums.resize(frames_.size(), 0.0);
    for (std::size_t frame = 0; frame < frames_.size(); ++frame) sums[frame] += series.ms[frame];
  }
  return all;
}

std::map<std::string, double> FrameTimes::pass_medians() const {
  std::map<std::string, double> medians;
  for (const auto& [pass, ms] : passes()) medians[pass] = median(ms);
  return medians;
}

bool FrameTimes::from_events() const {
  return std::ranges::all_of(stages(), &Series::from_events);
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
    session.queue().finish();
    const std::chrono::duration<double, std::milli> wall = Clock::now() - start;
    if (after) after();
    if (i >= 0) times.add(session.timeline().times(), {wall.count(), host});
  }
  return times;
}

nlohmann::json to_json(const std::vector<StageTime>& times) {
  nlohmann::json stages = nlohmann::json::array();
  for (const StageTime& time : times) {
    stages.push_back({{"stage", name_of(time.mark.pass)},
                      {"cascade", time.mark.cascade},
                      {"light", time.mark.light},
                      {"ms", time.ms},
                      {"timer", time.from_events ? "event" : "wall"}});
  }
  return stages;
}

std::vector<StageTime> stage_times_from_json(const nlohmann::json& json) {
  std::vector<StageTime> times;
  for (const nlohmann::json& stage : json) {
    times.push_back({{named<Pass>("stage", stage.at("stage").get<std::string>()),
                      stage.at("cascade").get<std::optional<int>>(),
                      stage.at("light").get<std::optional<int>>()},
                     stage.at("ms"),
                     stage.at("timer") == "event"});
  }
  return times;
}

}  // namespace clpv
