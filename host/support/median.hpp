// SPDX-License-Identifier: MIT
// Median of measurements: robust against a few outliers.
#pragma once

#include <algorithm>
#include <vector>

namespace clpv {

/// Returns the middle value, or the mean of the two middle values; 0 if `values` is empty.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace clpv
