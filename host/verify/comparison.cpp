// SPDX-License-Identifier: MIT
#include "verify/comparison.hpp"

#include <fmt/format.h>

namespace clpv::reference {

Comparison compare_volumes(std::span<const float> found, std::span<const double> expected, int n) {
  const WorstError worst = worst_difference(
      expected.size(), [&](std::size_t i) { return static_cast<double>(found[i]); },
      [&](std::size_t i) { return expected[i]; });
  if (worst.value == 0) return {};
  const std::size_t side = n;
  const std::size_t at = worst.at;
  return {worst.value,
          fmt::format("cell {},{},{} plane {}: {:.7g}, expected {:.7g}", at % side, at / side % side,
                      at / side / side % side, at / side / side / side, found[at], expected[at])};
}

}  // namespace clpv::reference
