// SPDX-License-Identifier: MIT
#include "sequence/sequence_report.hpp"

#include <algorithm>

#include "support/json_optional.hpp"
#include "support/statistics.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr int kSchema = 1;

}  // namespace

void TimesSummary::add(const FrameLine& line) {
  ++frames_;
  if (line.first) return;
  pose_.push_back(line.pose_ms);
  frame_.push_back(line.frame_ms);
  write_.push_back(line.write_ms);
  if (!line.stages.empty()) stages_.add(line.stages);  // none by a clock at fault
}

json TimesSummary::to_json() const {
  json all = {{"frames", frames_}, {"steady", frame_.size()}, {"times", json::array()}};
  if (frame_.empty()) return all;
  std::vector<TimeRecord> times = {time_record("pose", pose_), time_record("frame", frame_),
                                   time_record("write", write_)};
  std::ranges::move(stages_.stage_records(), std::back_inserter(times));
  all["times"] = times;
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
