// SPDX-License-Identifier: MIT
// Arithmetic that several tests need.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

namespace clpv::test {

inline std::vector<double> times(double factor, std::vector<double> values) {
  for (double& value : values) value *= factor;
  return values;
}

/// Mean of one channel of RGBA pixels.
inline double mean(std::span<const float> rgba, std::size_t channel) {
  double sum = 0;
  for (std::size_t i = channel; i < rgba.size(); i += 4) sum += double{rgba[i]};
  return 4 * sum / static_cast<double>(rgba.size());
}

template <typename Number>
requires std::is_arithmetic_v<Number>
double mean(const std::vector<Number>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Red, green and blue of RGBA pixels.
inline std::vector<std::array<float, 3>> colours(std::span<const float> rgba) {
  std::vector<std::array<float, 3>> all;
  for (std::size_t i = 0; i < rgba.size(); i += 4)
    all.push_back({rgba[i], rgba[i + 1], rgba[i + 2]});
  return all;
}

/// Mean of the first component.
template <typename T>
double mean(const std::vector<glm::vec<3, T>>& values) {
  double sum = 0;
  for (const auto& value : values) sum += double{value.x};
  return sum / static_cast<double>(values.size());
}

}  // namespace clpv::test
