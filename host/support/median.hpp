// SPDX-License-Identifier: MIT
// The middle of a series of measurements, which a few outliers do not move.
#pragma once

#include <algorithm>
#include <vector>

namespace clpv {

/// The middle value, or the mean of the two middle ones; 0 of none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace clpv
