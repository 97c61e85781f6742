// SPDX-License-Identifier: MIT
// Reports of `clpv sequence`: the summary in times.jsonl, and stability.json.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "sequence/stability.hpp"
#include "sequence/times_file.hpp"

namespace clpv {

/// Sums up times of frames, one after another.
class TimesSummary {
 public:
  void add(const FrameLine& line);

  /// Number of frames, and of those without first frames (`steady`). For each of pose, frame, write
  /// and each stage, cascade and light over steady frames: n, min, median, mad and max [ms]. A
  /// frame without a stage took 0 ms for it.
  nlohmann::json to_json() const;

 private:
  struct Series {
    StageMark mark;
    std::vector<double> ms;  ///< of steady frames that ran it
  };

  std::size_t frames_ = 0;
  std::vector<double> pose_, frame_, write_;  ///< [ms] of steady frames
  std::vector<Series> stages_;                ///< in order of first occurrence
};

/// Schema 1: the fields of `about`, the steps, and a summary of the steps with static lights and
/// triangles, grouped by whether a cascade moved.
nlohmann::json stability_json(const nlohmann::json& about, std::span<const StabilityStep> steps);

}  // namespace clpv
