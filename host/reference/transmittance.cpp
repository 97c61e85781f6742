// SPDX-License-Identifier: MIT
#include "reference/transmittance.hpp"

#include <algorithm>

#include "kernels/shared/sweep.h"

namespace clpv::reference {

double transmittance(const Volume& geometry, const glm::ivec3& cell, const glm::ivec3& side,
                     const std::vector<double>& weights) {
  std::vector<double> mean(weights.size(), 0.0);
  int corners = 0;
  for (int c = 0; c < 8; ++c) {
    const glm::ivec3 corner(c & 1, (c >> 1) & 1, c >> 2);
    bool on_side = true;
    for (int axis = 0; axis < 3; ++axis) {
      if (side[axis] != 0) on_side = on_side && corner[axis] == (side[axis] > 0 ? 1 : 0);
    }
    if (!on_side) continue;
    ++corners;
    const glm::ivec3 p = cell + corner;
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] += geometry.value(0, static_cast<int>(i), p.x, p.y, p.z);
  }
  double blocked = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) blocked += mean[i] / corners * weights[i];
  return 1.0 - std::clamp(blocked, 0.0, 1.0);
}

bool closed_link(const std::vector<std::uint8_t>& occluded, int n, const glm::ivec3& cell,
                 const glm::ivec3& side) {
  constexpr int kPoints = 64;
  for (int octant = 0; octant < 8; ++octant) {
    const glm::ivec3 upper(octant & 1, octant >> 1 & 1, octant >> 2), cube = cell - 1 + upper;
    bool crossed = true;
    for (int axis = 0; axis < 3; ++axis)
      crossed = crossed && (side[axis] == 0 || (side[axis] > 0) == (upper[axis] == 1));
    if (!crossed) continue;
    if (glm::any(glm::lessThan(cube, glm::ivec3(0))) ||
        glm::any(glm::greaterThan(cube, glm::ivec3(n - 2))))
      return false;
    const int here = 7 - octant, there = here + side.x + 2 * side.y + 4 * side.z;
    const auto first = static_cast<std::size_t>((cube.z * n + cube.y) * n + cube.x) * kPoints;
    for (int point = 0; point < kPoints; ++point)
      if ((occluded[first + point] & (1 << here | 1 << there)) == 0) return false;
  }
  return true;
}

}  // namespace clpv::reference
