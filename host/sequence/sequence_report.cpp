// SPDX-License-Identifier: MIT
#include "sequence/sequence_report.hpp"

#include <algorithm>

#include "pipeline/frame/frame_times.hpp"
#include "support/input_file.hpp"
#include "support/json_optional.hpp"
#include "support/log.hpp"
#include "support/statistics.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr int kSchema = 1;
constexpr const char* kSpans[] = {"pose", "frame", "write"};

/// Null without samples.
json summary_of(std::vector<double> samples) {
  if (samples.empty()) return nullptr;
  const Statistics figures = statistics_of(std::move(samples));
  return {{"median_ms", figures.median}, {"p95_ms", figures.p95}, {"worst_ms", figures.max}};
}

json summary_of(const std::vector<const json*>& frames) {
  FrameTimes times;
  for (const json* frame : frames) times.add(stage_times_from_json(frame->at("stages")));
  json stages = json::array();
  for (const FrameTimes::Series& series : times.stages()) {
    json summary = to_json({{series.mark, 0, series.from_events}})[0];
    summary.erase("ms");
    summary.erase("timer");
    summary.update(summary_of(series.ms));
    stages.push_back(std::move(summary));
  }
  json summary = {{"frames", frames.size()}, {"stages", std::move(stages)}};
  for (const std::string span : kSpans) {
    std::vector<double> samples;
    for (const json* frame : frames) samples.push_back(frame->at(span + "_ms"));
    summary[span] = summary_of(std::move(samples));
  }
  return summary;
}

}  // namespace

SequenceTimes read_times(const std::filesystem::path& file, int frames) {
  const auto text = file_bytes(file);
  if (!text) return {};
  SequenceTimes times;
  try {
    const json before = json::parse(*text);
    for (const json& frame : before.at("frames")) {
      summary_of({&frame});  // throws if a summarised field is missing
      frame.at("time").get<double>(), frame.at("first").get<bool>();
      if (const int number = frame.at("frame"); number < frames) times[number] = frame;
    }
    return times;
  } catch (const std::exception& error) {
    spdlog::warn("{}: times of existing frames are left out: {}", file.string(), error.what());
    return {};
  }
}

json times_json(const json& about, const SequenceTimes& times) {
  json all = about, frames = json::array();
  std::vector<const json*> steady;
  for (const auto& [number, frame] : times) {
    frames.push_back(frame);
    if (!frame.at("first").get<bool>()) steady.push_back(&frame);
  }
  all.update({{"schema", kSchema}, {"frames", std::move(frames)}, {"summary", summary_of(steady)}});
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
