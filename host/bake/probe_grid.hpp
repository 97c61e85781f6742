// SPDX-License-Identifier: MIT
// A regular grid of probes, x fastest, and look-ups between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace clpv::bake {

/// `lower` and `upper` are the positions of the outermost probes [m]; a single probe along an axis
/// is in the middle.
struct ProbeGrid {
  glm::ivec3 count{2};
  glm::dvec3 lower{0}, upper{1};

  std::size_t size() const {
    return static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) *
           static_cast<std::size_t>(count.z);
  }
  /// Distance of neighbours [m]; of a single probe: the edge.
  glm::dvec3 spacing() const { return (upper - lower) / glm::dvec3(glm::max(count - 1, 1)); }
  std::size_t index(const glm::ivec3& at) const {
    return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(count.y) +
            static_cast<std::size_t>(at.y)) *
               static_cast<std::size_t>(count.x) +
           static_cast<std::size_t>(at.x);
  }
  glm::ivec3 at(std::size_t index) const {
    const auto x = static_cast<std::size_t>(count.x), y = static_cast<std::size_t>(count.y);
    return {static_cast<int>(index % x), static_cast<int>(index / x % y),
            static_cast<int>(index / (x * y))};
  }
  glm::dvec3 position(std::size_t index) const {
    const glm::ivec3 place = at(index);
    glm::dvec3 p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = count[axis] == 1 ? (lower[axis] + upper[axis]) / 2
                                 : lower[axis] + place[axis] * spacing()[axis];
    return p;
  }
  glm::dvec3 first() const { return position(0); }
  glm::dvec3 last() const { return position(size() - 1); }
  /// Returns true if a position is more than half a spacing outside the bounds.
  bool is_far(const glm::dvec3& position) const {
    const glm::dvec3 outside = glm::max(lower - position, position - upper);
    return glm::any(glm::greaterThan(outside, spacing() / 2.0));
  }
};

/// Positions of all probes.
inline std::vector<glm::dvec3> positions_of(const ProbeGrid& grid) {
  std::vector<glm::dvec3> positions;
  for (std::size_t i = 0; i < grid.size(); ++i) positions.push_back(grid.position(i));
  return positions;
}

/// Trilinear interpolation of `n` numbers per probe at a position [m], which is clamped to the
/// grid.
inline std::vector<glm::dvec3> interpolated(const ProbeGrid& grid,
                                            std::span<const glm::vec3> coefficients, std::size_t n,
                                            const glm::dvec3& position) {
  const glm::dvec3 t = (position - grid.lower) / grid.spacing();
  glm::ivec3 low;
  glm::dvec3 part;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::clamp(t[axis], 0.0, grid.count[axis] - 1.0);
    low[axis] = std::min(static_cast<int>(at), std::max(grid.count[axis] - 2, 0));
    part[axis] = at - low[axis];
  }
  std::vector<glm::dvec3> sum(n, glm::dvec3(0));
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 off(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 shares = glm::mix(1.0 - part, part, glm::dvec3(off));
    const double weight = shares.x * shares.y * shares.z;
    if (weight == 0) continue;
    const std::size_t first = grid.index(low + off) * n;
    for (std::size_t i = 0; i < n; ++i) sum[i] += weight * glm::dvec3(coefficients[first + i]);
  }
  return sum;
}

}  // namespace clpv::bake
