// SPDX-License-Identifier: MIT
// Reports of `clpv sequence`: times.json and stability.json.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "sequence/stability.hpp"

namespace clpv {

/// Wall times of frames [ms] as JSON, by frame number. pose_ms: scene animation on host and device.
/// frame_ms: all stages, until the device has finished. write_ms: readback, encoding and writing.
/// `first`: first frame of a run, whose launches may compile kernels.
using SequenceTimes = std::map<int, nlohmann::json>;

/// Reads the times of frames below `frames` from an earlier run's times.json. Empty, with a
/// warning, if the file is invalid.
SequenceTimes read_times(const std::filesystem::path& file, int frames);

/// Schema 1: the fields of `about`, the frames, and the median, 95th percentile and maximum of
/// pose_ms, frame_ms, write_ms and each stage, cascade and light, without first frames. A frame
/// without a stage took 0 ms for it.
nlohmann::json times_json(const nlohmann::json& about, const SequenceTimes& times);

/// Schema 1: the fields of `about`, the steps, and a summary of the steps with static lights and
/// triangles, grouped by whether a cascade moved.
nlohmann::json stability_json(const nlohmann::json& about, std::span<const StabilityStep> steps);

}  // namespace clpv
