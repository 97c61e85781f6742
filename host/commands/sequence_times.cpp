// SPDX-License-Identifier: MIT
#include "commands/sequence_times.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/statistics.hpp"
#include "support/input_file.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr int kSchema = 1;

json number_or_null(const std::optional<int>& value) {
  return value ? json(*value) : json(nullptr);
}

json summary_of(std::vector<double> samples) {
  const bench::Statistics figures = bench::statistics_of(std::move(samples));
  return {{"median_ms", figures.median}, {"p95_ms", figures.p95}, {"worst_ms", figures.max}};
}

/// Of each stage, cascade and light, in the order they first come in.
json summary_of_stages(const std::vector<const json*>& frames) {
  std::vector<std::pair<json, std::vector<double>>> stages;
  for (const json* frame : frames) {
    for (const json& stage : frame->at("stages")) {
      const json which = {
          {"stage", stage.at("stage")}, {"cascade", stage.at("cascade")}, {"light", stage.at("light")}};
      auto found = std::ranges::find(stages, which, &std::pair<json, std::vector<double>>::first);
      if (found == stages.end()) found = stages.emplace(found, which, std::vector<double>());
      found->second.push_back(stage.at("ms"));
    }
  }
  json all = json::array();
  for (auto& [which, samples] : stages) {
    samples.resize(frames.size(), 0.0);
    json summary = which;
    summary.update(summary_of(std::move(samples)));
    all.push_back(std::move(summary));
  }
  return all;
}

}  // namespace

SequenceTimes::SequenceTimes() = default;
SequenceTimes::~SequenceTimes() = default;

void SequenceTimes::keep(const std::filesystem::path& file, const std::vector<int>& frames) {
  const auto text = file_bytes(file);
  if (!text || frames.empty()) return;
  try {
    const json before = json::parse(*text);
    for (const json& frame : before.at("frames")) {
      const int number = frame.at("frame");
      if (std::ranges::find(frames, number) == frames.end()) continue;
      summary_of_stages({&frame});  // whether it can be summed up
      for (const char* key : {"time", "pose_ms", "frame_ms", "write_ms"}) frame.at(key).get<double>();
      frame.at("first").get<bool>();
      frames_[number] = frame;
    }
  } catch (const json::exception& error) {
    spdlog::warn("{}: the times of frames that were there are left out: {}", file.string(), error.what());
  }
}

void SequenceTimes::merge(const json& told) {
  for (const json& frame : told.at("frames")) frames_[frame.at("frame").get<int>()] = frame;
}

void SequenceTimes::add(int frame, double seconds, const FrameTimes& times) {
  json stages = json::array();
  for (const StageTime& stage : times.stages) {
    stages.push_back({{"stage", name_of(stage.mark.pass)},
                      {"cascade", number_or_null(stage.mark.cascade)},
                      {"light", number_or_null(stage.mark.light)},
                      {"ms", stage.ms},
                      {"timer", stage.from_events ? "event" : "wall"}});
  }
  frames_[frame] = {{"frame", frame},
                    {"time", seconds},
                    {"first", times.first},
                    {"pose_ms", times.pose_ms},
                    {"frame_ms", times.frame_ms},
                    {"write_ms", times.write_ms},
                    {"stages", std::move(stages)}};
}

json SequenceTimes::to_json(const json& about) const {
  json all = about, frames = json::array();
  std::vector<const json*> steady;
  for (const auto& [number, frame] : frames_) {
    frames.push_back(frame);
    if (!frame.at("first").get<bool>()) steady.push_back(&frame);
  }
  json summary = {{"frames", steady.size()}, {"stages", summary_of_stages(steady)}};
  for (const char* key : {"pose_ms", "frame_ms", "write_ms"}) {
    std::vector<double> samples;
    for (const json* frame : steady) samples.push_back(frame->at(key));
    summary[std::string(key).substr(0, std::string(key).size() - 3)] = summary_of(std::move(samples));
  }
  all.update({{"schema", kSchema}, {"frames", std::move(frames)}, {"summary", std::move(summary)}});
  return all;
}

}  // namespace clpv
