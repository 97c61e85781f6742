// SPDX-License-Identifier: MIT
// How far a result is from its CPU reference's: the one comparison of checks and benchmarks.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace clpv::reference {

/// The worst of the errors it was shown. A NaN is worse than any number, and stays.
struct WorstError {
  double value = 0;
  std::size_t at = 0;  ///< which one it was

  /// Whether `error` is the worst so far.
  bool take(double error, std::size_t index) {
    if (std::isnan(value) || error <= value) return false;
    value = error, at = index;
    return true;
  }
};

/// Of `count` values found(i), wanted(i): the largest difference, over the largest |wanted|.
template <typename Found, typename Wanted>
WorstError worst_difference(std::size_t count, const Found& found, const Wanted& wanted) {
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i)
    largest = std::max(largest, std::abs(static_cast<double>(wanted(i))));
  WorstError worst;
  for (std::size_t i = 0; i < count; ++i) worst.take(std::abs(found(i) - wanted(i)) / largest, i);
  return worst;
}

struct Comparison {
  double worst = 0;   ///< over the CPU reference's largest value
  std::string place;  ///< "cell 3,4,5 plane 0: 0.25, CPU reference 0.26"; empty where nothing differs
};

/// Volumes of n^3 samples in Volume's host order.
Comparison compare_volumes(std::span<const float> found, std::span<const double> expected, int n);

/// The functions that volumes hold, in 26 directions: where a Gram matrix is ill-conditioned coefficients differ by which
/// functions hardly do. `numbers` a sample and channel; `weights`: theirs in a direction. `other` is as right as `CPU reference`.
Comparison compare_functions(std::span<const float> found, std::span<const double> expected,
                             std::span<const double> other, int n, int numbers,
                             const std::function<std::vector<double>(const glm::dvec3&)>& weights);

}  // namespace clpv::reference
