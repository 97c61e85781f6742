// SPDX-License-Identifier: MIT
// What a series of measurements comes to.
#pragma once

#include <vector>

namespace clpv::bench {

/// Of one series, in its unit. All 0 where it is empty.
struct Statistics {
  double min = 0, median = 0, p95 = 0, max = 0;
  double mad = 0;  ///< median absolute deviation from the median: a spread that a few outliers do not move
};

/// Quantiles interpolate linearly between the sorted samples, the first at 0 and the last at 1.
Statistics statistics_of(std::vector<double> samples);

/// Least-squares slope of log y over log x: y grows as x to this power. At least two different x, all positive.
double growth_exponent(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace clpv::bench
