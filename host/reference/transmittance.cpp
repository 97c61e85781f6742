// SPDX-License-Identifier: MIT
#include "reference/transmittance.hpp"

#include <algorithm>

namespace clpv::reference {
namespace {

constexpr int kPointsOfCube = 64;

/// Cube at an octant of a cell, in which the cell's centre is number 7 - octant.
glm::ivec3 cube_at(const glm::ivec3& cell, int octant) {
  return cell - 1 + glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2);
}

/// Index of a cube's first point.
std::size_t first_point(int n, const glm::ivec3& cube) {
  return static_cast<std::size_t>((cube.z * n + cube.y) * n + cube.x) * kPointsOfCube;
}

}  // namespace

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

double seen_share(const std::vector<std::uint8_t>& occluded, int n, const glm::ivec3& cell,
                  const glm::ivec3& side) {
  int both = 0, either = 0;
  for (int octant = 0; octant < 8; ++octant) {
    const glm::ivec3 cube = cube_at(cell, octant), upper = cube - cell + 1;
    bool crossed = true;
    for (int axis = 0; axis < 3; ++axis)
      crossed = crossed && (side[axis] == 0 || (side[axis] > 0) == (upper[axis] == 1));
    if (!crossed) continue;
    const glm::ivec3 nearest = glm::clamp(cube, 0, std::max(n - 2, 0));
    int here = 7 - octant, there = here + side.x + 2 * side.y + 4 * side.z;
    for (int axis = 0; axis < 3; ++axis) {
      if (nearest[axis] == cube[axis]) continue;
      const int bit = 1 << axis, inner = nearest[axis] < cube[axis] ? bit : 0;
      here = (here & ~bit) | inner, there = (there & ~bit) | inner;
    }
    for (int point = 0; point < kPointsOfCube; ++point) {
      const int hidden = occluded[first_point(n, nearest) + point];
      const bool sees_here = (hidden >> here & 1) == 0, sees_there = (hidden >> there & 1) == 0;
      both += sees_here && sees_there, either += sees_here || sees_there;
    }
  }
  return both / std::max<double>(either, 1);
}

std::vector<SeenCentres> seen_centres(const std::vector<std::uint8_t>* occluded, int n,
                                      const glm::dvec3& at) {
  const glm::ivec3 cube(glm::floor(at)), octant(2.0 * (at - glm::floor(at)));
  const bool within = glm::clamp(cube, 0, std::max(n - 2, 0)) == cube;
  std::vector<SeenCentres> points(8);
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 place = 2 * octant + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
    const std::size_t point = first_point(n, cube) + (place.z * 4 + place.y) * 4 + place.x;
    const int hidden = occluded != nullptr && within ? (*occluded)[point] : 0;
    for (int centre = 0; centre < 8; ++centre)
      if ((hidden >> centre & 1) == 0)
        points[i].insert(
            {cube.x + (centre & 1), cube.y + (centre >> 1 & 1), cube.z + (centre >> 2)});
  }
  return points;
}

}  // namespace clpv::reference
