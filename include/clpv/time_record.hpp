// SPDX-License-Identifier: MIT
// The record of a measured time, in the API and in all JSON of clpv.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// Times [ms] of a stage over `n` frames or repetitions; a frame without it counts as 0.
struct TimeRecord {
  std::string stage;                    ///< "rasterize-camera", "propagate", ...; "frame": all
  std::optional<int> cascade = {};      ///< from 0 (finest); none: all, or no cascades
  std::optional<int> light = {};        ///< index in the scene; none: all, or no lights
  std::size_t n = 0;                    ///< number of samples
  double min = 0, median = 0, mad = 0;  ///< mad: median absolute deviation from the median
  double max = 0;
};

/// Returns the sum of the medians of a stage over its cascades and lights [ms]; 0 if it did not
/// run.
double ms_of(const std::vector<TimeRecord>& times, std::string_view stage);

}  // namespace clpv
