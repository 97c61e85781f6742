// SPDX-License-Identifier: MIT
// A triangle projected along an axis of a grid and sampled, as in kernels/voxels/blockers.cl and
// kernels/voxels/reflectors.cl.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>

#include "reference/triangle.hpp"
#include "reference/view.hpp"

namespace clpv::reference {

/// A triangle in cells of the grid, projected along `axis`. Samples lie in the plane of the next
/// two axes u and v, kSamples per cell along each.
class AxisTriangle {
 public:
  /// `corners` in cells.
  AxisTriangle(int axis, const std::array<glm::dvec3, 3>& corners)
      : axis_(axis), corners_(corners) {
    for (glm::dvec3& c : corners_) c = {c[(axis + 1) % 3], c[(axis + 2) % 3], c[axis]};
    const glm::dvec3 across = glm::cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
    area_ = across.z;
    if (area_ != 0) normal_ = glm::normalize(across);
  }

  /// Selects the side that faces up or down the axis, and moves the triangle half a cell to that
  /// side.
  void lift(bool up) {
    if (up != this->up()) normal_ = -normal_;
    const glm::dvec3 aside = normal_ / 2.0;
    for (glm::dvec3& c : corners_)
      c += glm::dvec3(std::rint(kSamples * aside.x) / kSamples,
                      std::rint(kSamples * aside.y) / kSamples, aside.z);
  }

  bool has_area() const { return area_ != 0; }  ///< projected area, not 0
  int axis() const { return axis_; }
  bool up() const { return normal_.z > 0; }
  /// Weight of a sample: the weights of a triangle's three axes together count its area once.
  double weight() const {
    return 1 / (std::abs(normal_.x) + std::abs(normal_.y) + std::abs(normal_.z));
  }
  /// Barycentric coordinates of the second and third corner, clamped to the triangle.
  glm::vec2 clamped_weights(const glm::dvec2& at) const {
    const glm::dvec2 w = weights(at);
    const double x = std::clamp(w.x, 0.0, 1.0);
    return {x, std::clamp(w.y, 0.0, 1 - x)};
  }
  /// Depth along the axis, clamped to the range of the corners.
  double depth(const glm::dvec2& at) const {
    const glm::dvec2 w = weights(at);
    const auto [nearest, farthest] = depths();
    return std::clamp(corners_[0].z + w.x * (corners_[1].z - corners_[0].z) +
                          w.y * (corners_[2].z - corners_[0].z),
                      nearest, farthest);
  }
  /// Minimum and maximum depth of the corners.
  std::pair<double, double> depths() const {
    return std::minmax({corners_[0].z, corners_[1].z, corners_[2].z});
  }
  /// Signed distance to the nearest edge [samples], positive inside; seams count as inside.
  double edge_distance(const glm::dvec2& at) const {
    double smallest = 1e300;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 a(corners_[i]), edge = glm::dvec2(corners_[(i + 1) % 3]) - a;
      const double across = (area_ < 0 ? -1 : 1) * cross(edge, at - a);
      smallest =
          std::min(smallest, kSamples * across / (std::abs(edge.x) + std::abs(edge.y)) + kSeam);
    }
    return smallest;
  }
  /// Change of depth from sample to sample along u and v [cells].
  glm::dvec2 slope() const {
    return glm::dvec2(normal_.x, normal_.y) / -normal_.z / double{kSamples};
  }
  /// First and last sample along u (0) or v (1) that may be covered, within `n` cells.
  std::pair<int, int> range(int along, int n) const {
    const auto [low, high] =
        std::minmax({corners_[0][along], corners_[1][along], corners_[2][along]});
    const double last = kSamples * n - 1;
    return {static_cast<int>(std::clamp(std::floor(kSamples * low - 1), 0.0, last + 1)),
            static_cast<int>(std::clamp(std::ceil(kSamples * high), -1.0, last))};
  }
  /// Cell with these indices along u, v and the axis.
  glm::ivec3 cell(int u, int v, int along) const {
    glm::ivec3 cell;
    cell[(axis_ + 1) % 3] = u, cell[(axis_ + 2) % 3] = v, cell[axis_] = along;
    return cell;
  }

 private:
  glm::dvec2 weights(const glm::dvec2& at) const {
    const glm::dvec2 from = at - glm::dvec2(corners_[0]);
    const glm::dvec2 e1(corners_[1] - corners_[0]), e2(corners_[2] - corners_[0]);
    return glm::dvec2(cross(from, e2), cross(e1, from)) / area_;
  }

  int axis_;
  std::array<glm::dvec3, 3> corners_;  ///< along u, v and the axis
  double area_ = 0;                    ///< twice the projected area
  glm::dvec3 normal_{0};
};

/// Centre of a sample [cells].
inline glm::dvec2 sample_centre(double u, double v) {
  return (glm::dvec2(u, v) + 0.5) / double{kSamples};
}

}  // namespace clpv::reference
