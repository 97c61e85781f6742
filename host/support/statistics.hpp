// SPDX-License-Identifier: MIT
// Statistics of measurements.
#pragma once

#include <utility>
#include <vector>

namespace clpv {

/// Statistics of a series, in its unit. All 0 for an empty series.
struct Statistics {
  double min = 0, median = 0, p95 = 0, max = 0;
  double mad = 0;  ///< median absolute deviation from the median, robust against outliers
};

/// Quantiles interpolate linearly between the sorted samples; the first is quantile 0, the last
/// quantile 1.
Statistics statistics_of(std::vector<double> samples);

inline double median(std::vector<double> samples) {
  return statistics_of(std::move(samples)).median;
}

}  // namespace clpv
