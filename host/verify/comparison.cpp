// SPDX-License-Identifier: MIT
#include "verify/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clpv::verify {

Deviation compare_volumes(std::span<const float> found, std::span<const double> expected, int n,
                          double allowed) {
  const WorstError worst = worst_difference(
      expected.size(), [&](std::size_t i) { return static_cast<double>(found[i]); },
      [&](std::size_t i) { return expected[i]; });
  if (worst.value == 0) return {0, allowed};
  const std::size_t side = n;
  const std::size_t at = worst.at;
  return {
      worst.value, allowed,
      fmt::format("cell {},{},{} plane {}: {:.7g}, expected {:.7g}", at % side, at / side % side,
                  at / side / side % side, at / side / side / side, found[at], expected[at])};
}

std::vector<glm::dvec3> compared_directions() {
  std::vector<glm::dvec3> directions;
  for (int neighbour = 0; neighbour < 27; ++neighbour) {
    if (neighbour == 13) continue;  // the cell itself
    directions.push_back(
        glm::normalize(glm::dvec3(neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1)));
  }
  return directions;
}

Deviation compare_functions(std::span<const float> found, std::span<const double> expected,
                            std::span<const double> other, int n, int numbers,
                            const std::function<std::vector<double>(const glm::dvec3&)>& weights,
                            double allowed) {
  const std::size_t side = n, samples = side * side * side, size = numbers;
  double largest = 0;
  WorstError worst;
  Deviation result{0, allowed};
  for (const glm::dvec3& w : compared_directions()) {
    const std::vector<double> b = weights(w);
    for (std::size_t at = 0; at < found.size() / size; ++at) {
      double value = 0, wanted = 0, or_wanted = 0;
      for (std::size_t i = 0; i < size; ++i) {
        const std::size_t index = (at / samples * size + i) * samples + at % samples;
        value += b[i] * found[index];
        wanted += b[i] * expected[index];
        or_wanted += b[i] * other[index];
      }
      largest = std::max(largest, std::abs(wanted));
      if (!worst.take(std::min(std::abs(value - wanted), std::abs(value - or_wanted)), at))
        continue;
      result.place = fmt::format(
          "cell {},{},{} channel {} towards {:.2f},{:.2f},{:.2f}: {:.7g}, expected {:.7g}",
          at % side, at / side % side, at / side / side % side, at / samples, w.x, w.y, w.z, value,
          wanted);
    }
  }
  result.worst = worst.value / largest;
  return result;
}

}  // namespace clpv::verify
