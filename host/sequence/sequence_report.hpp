// SPDX-License-Identifier: MIT
// Reports of `clpv sequence`: the summary in times.jsonl, and stability.json.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "sequence/stability.hpp"
#include "sequence/times_file.hpp"
#include "times/frame_times.hpp"

namespace clpv {

/// Sums up times of frames, one after another.
class TimesSummary {
 public:
  void add(const FrameLine& line);

  /// Number of frames, and of those without first frames (`steady`); `times`: records of pose,
  /// frame, write and the stages over steady frames.
  nlohmann::json to_json() const;

 private:
  std::size_t frames_ = 0;
  std::vector<double> pose_, frame_, write_;  ///< [ms] of steady frames
  FrameTimes stages_;                         ///< times of steady frames
};

/// Schema 1: the fields of `about`, the steps, and a summary of the steps with static lights and
/// triangles, grouped by whether a cascade moved.
nlohmann::json stability_json(const nlohmann::json& about, std::span<const StabilityStep> steps);

}  // namespace clpv
