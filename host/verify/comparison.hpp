// SPDX-License-Identifier: MIT
// Errors between results and their CPU references.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "verify/job.hpp"

namespace clpv::verify {

/// Largest of the recorded errors. A NaN exceeds any number and stays.
struct WorstError {
  double value = 0;
  std::size_t at = 0;  ///< index of the largest error

  /// Returns true if `error` is the largest so far.
  bool take(double error, std::size_t index) {
    if (std::isnan(value) || error <= value) return false;
    value = error, at = index;
    return true;
  }
};

/// Returns the largest difference of `count` values found(i) and wanted(i), relative to the largest
/// |wanted|.
template <typename Found, typename Wanted>
WorstError worst_difference(std::size_t count, const Found& found, const Wanted& wanted) {
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i)
    largest = std::max(largest, std::abs(static_cast<double>(wanted(i))));
  WorstError worst;
  for (std::size_t i = 0; i < count; ++i) worst.take(std::abs(found(i) - wanted(i)) / largest, i);
  return worst;
}

/// Compares volumes of n^3 samples in Volume's host order, relative to the largest expected value.
Deviation compare_volumes(std::span<const float> found, std::span<const double> expected, int n,
                          double allowed = 0);

/// Returns the 26 directions of compare_functions().
std::vector<glm::dvec3> compared_directions();

/// Compares the functions that volumes represent, in 26 directions. With an ill-conditioned Gram
/// matrix, coefficients differ while the functions agree. `numbers`: values per sample and channel.
/// `weights`: their weights in a direction. `other`: a second reference result, as accurate as
/// `expected`.
Deviation compare_functions(std::span<const float> found, std::span<const double> expected,
                            std::span<const double> other, int n, int numbers,
                            const std::function<std::vector<double>(const glm::dvec3&)>& weights,
                            double allowed = 0);

}  // namespace clpv::verify
