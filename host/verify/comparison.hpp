// SPDX-License-Identifier: MIT
// Error between a result and its CPU reference, for checks and benchmarks.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace clpv::reference {

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

/// Returns the largest difference of `count` values found(i) and wanted(i), relative to the largest |wanted|.
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
  double worst = 0;   ///< relative to the CPU reference's largest value
  std::string place;  ///< "cell 3,4,5 plane 0: 0.25, CPU reference 0.26"; empty if nothing differs
};

/// Compares volumes of n^3 samples in Volume's host order.
Comparison compare_volumes(std::span<const float> found, std::span<const double> expected, int n);

/// Compares the functions that volumes represent, in 26 directions. With an ill-conditioned Gram matrix, coefficients
/// differ while the functions agree. `numbers`: values per sample and channel. `weights`: their weights in a direction.
/// `other`: a second reference result, as accurate as `expected`.
Comparison compare_functions(std::span<const float> found, std::span<const double> expected,
                             std::span<const double> other, int n, int numbers,
                             const std::function<std::vector<double>(const glm::dvec3&)>& weights);

}  // namespace clpv::reference
