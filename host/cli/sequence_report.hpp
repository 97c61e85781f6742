// SPDX-License-Identifier: MIT
// What `clpv sequence` writes beside its frames: times.json and stability.json.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "quality/stability.hpp"

namespace clpv {

/// Wall times of frames [ms] as JSON, by the frames' numbers: pose_ms, the scene brought to its instant, on host and device;
/// frame_ms, all stages, until the device is done; write_ms, read back, encoded and written. `first` of a run: its launches may
/// compile.
using SequenceTimes = std::map<int, nlohmann::json>;

/// Those of frames below `frames` that a times.json of an earlier run holds; none, with a warning, where it holds something
/// else.
SequenceTimes read_times(const std::filesystem::path& file, int frames);

/// Schema 1: all that `about` has, the frames, and over all but first ones the median, 95th percentile and worst of pose_ms,
/// frame_ms, write_ms and each stage, cascade and light. A frame without a stage took 0 ms for it.
nlohmann::json times_json(const nlohmann::json& about, const SequenceTimes& times);

/// Schema 1: all that `about` has, the steps, and a summary of those before which neither lights nor triangles changed, by
/// whether a cascade moved.
nlohmann::json stability_json(const nlohmann::json& about, std::span<const StabilityStep> steps);

}  // namespace clpv
