// SPDX-License-Identifier: MIT
#include "sequence/sequence_report.hpp"

#include <algorithm>

#include "support/json_optional.hpp"
#include "support/statistics.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr int kSchema = 1;

/// Statistics of `frames` samples [ms]; those that are not given are 0.
json statistics_json(std::vector<double> samples, std::size_t frames) {
  samples.resize(frames, 0.0);
  const Statistics figures = statistics_of(std::move(samples));
  return {{"n", frames},
          {"min", figures.min},
          {"median", figures.median},
          {"mad", figures.mad},
          {"max", figures.max}};
}

}  // namespace

void TimesSummary::add(const FrameLine& line) {
  ++frames_;
  if (line.first) return;
  pose_.push_back(line.pose_ms);
  frame_.push_back(line.frame_ms);
  write_.push_back(line.write_ms);
  for (const StageTime& time : line.stages) {
    auto found = std::ranges::find(stages_, time.mark, &Series::mark);
    if (found == stages_.end()) found = stages_.insert(found, {time.mark, {}});
    found->ms.push_back(time.ms);
  }
}

json TimesSummary::to_json() const {
  const std::size_t steady = frame_.size();
  json all = {{"frames", frames_}, {"steady", steady}, {"stages", json::array()}};
  if (steady == 0) return all;
  for (const auto& [name, samples] :
       {std::pair("pose", &pose_), std::pair("frame", &frame_), std::pair("write", &write_)})
    all[name] = statistics_json(*samples, steady);
  for (const Series& series : stages_) {
    json stage = statistics_json(series.ms, steady);
    stage.update({{"stage", name_of(series.mark.pass)},
                  {"cascade", series.mark.cascade},
                  {"light", series.mark.light}});
    all["stages"].push_back(std::move(stage));
  }
  return all;
}

json stability_json(const json& about, std::span<const StabilityStep> steps) {
  json all = about, frames = json::array();
  std::vector<double> inside, across;
  for (const StabilityStep& step : steps) {
    frames.push_back({{"frame", step.frame},
                      {"time", step.seconds},
                      {"still", step.still},
                      {"cascades_moved", step.cascades_moved},
                      {"seen", step.seen},
                      {"change", step.change.mean},
                      {"change_p95", step.change.p95},
                      {"traced", step.noise}});
    if (step.still && step.change.mean)
      (step.cascades_moved.empty() ? inside : across).push_back(*step.change.mean);
  }
  all.update({{"schema", kSchema}, {"frames", std::move(frames)}});
  for (const auto& [name, samples] :
       {std::pair("inside_cells", inside), std::pair("across_cells", across)}) {
    if (samples.empty()) {
      all["summary"][name] = nullptr;
      all["note"] =
          "null: no two successive frames of an unchanged scene show light under that condition";
      continue;
    }
    const Statistics figures = statistics_of(samples);
    all["summary"][name] = {{"frames", samples.size()},
                            {"median", figures.median},
                            {"p95", figures.p95},
                            {"worst", figures.max}};
  }
  return all;
}

}  // namespace clpv
