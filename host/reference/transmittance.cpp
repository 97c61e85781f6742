// SPDX-License-Identifier: MIT
#include "reference/transmittance.hpp"

#include <algorithm>

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

}  // namespace clpv::reference
