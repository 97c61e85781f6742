// SPDX-License-Identifier: MIT
#include "reference/blockers.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>

#include "reference/materials.hpp"
#include "reference/triangle.hpp"
#include "reference/view.hpp"

namespace clpv::reference {
namespace {

constexpr double kHair = 2e-3;  // [samples], [cells / 8]: what float32 may decide either way

using Mask = std::bitset<kSamples * kSamples>;

/// Masks [axis][z][y][x] of corners.
struct Masks {
  int n;
  std::vector<Mask> bits;
  explicit Masks(int corners) : n(corners), bits(static_cast<std::size_t>(3 * corners * corners * corners)) {}
  Mask& at(int axis, const glm::ivec3& c) { return bits[((axis * n + c.z) * n + c.y) * n + c.x]; }
};

/// A triangle seen along an axis: corners (u, v) in samples, depth in cells.
struct Seen {
  int axis;
  std::array<glm::dvec2, 3> corner;
  std::array<double, 3> depth;
};

Seen seen_along(int axis, const std::array<glm::dvec3, 3>& corners, const ClpvGrid& grid) {
  Seen seen{axis, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 cells = (corners[i] - vector(grid.origin)) / double{grid.cell} + 0.5;
    seen.corner[i] = double{kSamples} * glm::dvec2(cells[(axis + 1) % 3], cells[(axis + 2) % 3]);
    seen.depth[i] = cells[axis];
  }
  return seen;
}

/// How far inside the triangle a sample is [samples]: the least over its edges, their seams included.
double inside(const Seen& seen, const glm::dvec2& at, double area) {
  double least = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec2 a = seen.corner[i], edge = seen.corner[(i + 1) % 3] - a;
    const double breadth = std::abs(edge.x) + std::abs(edge.y);
    least = std::min(least, (area < 0 ? -1 : 1) * cross(edge, at - a) / breadth + kSeam);
  }
  return least;
}

class Rasters {
 public:
  Rasters(const Scene& scene, const ClpvGrid& grid)
      : scene_(scene), materials_(scene), grid_(grid), least(static_cast<int>(grid.n) + 1), most(least) {}

  void add(std::uint32_t triangle) {
    const Triangle& t = scene_.triangles[triangle];
    std::array<glm::dvec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = glm::dvec3(position(scene_.vertices[t.vertex[i]]));
    for (int axis = 0; axis < 3; ++axis) add_seen(triangle, seen_along(axis, corners, grid_));
  }

 private:
  const Scene& scene_;
  Materials materials_;
  const ClpvGrid& grid_;

 public:
  Masks least, most;

 private:
  void add_seen(std::uint32_t triangle, const Seen& seen) {
    const double area = cross(seen.corner[1] - seen.corner[0], seen.corner[2] - seen.corner[0]);
    if (area == 0) return;
    glm::dvec2 low = seen.corner[0], high = low;
    for (const glm::dvec2& c : seen.corner) low = glm::min(low, c), high = glm::max(high, c);
    const double last = kSamples * (grid_.n + 1.0) - 1;
    low = glm::clamp(glm::floor(low - 1.0), 0.0, last + 1), high = glm::clamp(glm::ceil(high), -1.0, last);
    for (int v = static_cast<int>(low.y); v <= high.y; ++v) {
      for (int u = static_cast<int>(low.x); u <= high.x; ++u) add_sample(triangle, seen, area, u, v);
    }
  }

  void add_sample(std::uint32_t triangle, const Seen& seen, double area, int u, int v) {
    const glm::dvec2 at(u + 0.5, v + 0.5);
    const double within = inside(seen, at, area);
    if (within < -kHair) return;
    const double w1 = cross(at - seen.corner[0], seen.corner[2] - seen.corner[0]) / area;
    const double w2 = cross(seen.corner[1] - seen.corner[0], at - seen.corner[0]) / area;
    const double depth =
        seen.depth[0] + w1 * (seen.depth[1] - seen.depth[0]) + w2 * (seen.depth[2] - seen.depth[0]);
    const auto [nearest, farthest] = std::minmax({seen.depth[0], seen.depth[1], seen.depth[2]});
    const double x = std::clamp(w1, 0.0, 1.0), y = std::clamp(w2, 0.0, 1 - x);
    const double solid = materials_.solidity({triangle, glm::vec2(x, y)});
    if (solid < -kAlphaHair) return;
    const bool sure = within > kHair && solid > kAlphaHair;
    // Steep triangles err most in depth where rounding moves the sample.
    const double steep = std::min((farthest - nearest), kHair * std::max(1.0, slope(seen, area)));
    const double clamped = std::clamp(depth, nearest, farthest), hair = kHair / kSamples + steep;
    const int first = static_cast<int>(std::floor(clamped - hair)),
              last = static_cast<int>(std::floor(clamped + hair));
    for (int k = first; k <= last; ++k) set(most, seen.axis, u, v, k);
    if (sure && first == last) set(least, seen.axis, u, v, first);
  }

  /// The depth's change a sample [cells].
  static double slope(const Seen& seen, double area) {
    const glm::dvec2 e1 = seen.corner[1] - seen.corner[0], e2 = seen.corner[2] - seen.corner[0];
    const double d1 = seen.depth[1] - seen.depth[0], d2 = seen.depth[2] - seen.depth[0];
    return (std::abs(d1 * e2.y - d2 * e1.y) + std::abs(d2 * e1.x - d1 * e2.x)) / std::abs(area);
  }

  void set(Masks& masks, int axis, int u, int v, int k) const {
    if (k < 0 || k >= masks.n) return;
    glm::ivec3 corner(0);
    corner[(axis + 1) % 3] = u / kSamples;
    corner[(axis + 2) % 3] = v / kSamples;
    corner[axis] = k;
    masks.at(axis, corner).set(static_cast<std::size_t>(v % kSamples * kSamples + u % kSamples));
  }
};

Volume shares(Masks& masks) {
  Volume volume(masks.n, 3, 1);
  for (int axis = 0; axis < 3; ++axis) {
    for (int z = 0; z < masks.n; ++z) {
      for (int y = 0; y < masks.n; ++y) {
        for (int x = 0; x < masks.n; ++x) {
          volume.at(0, axis, x, y, z) =
              static_cast<double>(masks.at(axis, {x, y, z}).count()) / (kSamples * kSamples);
        }
      }
    }
  }
  return volume;
}

}  // namespace

Blocked block(const Scene& scene, const ClpvGrid& grid) {
  Rasters rasters(scene, grid);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) rasters.add(t);
  return {shares(rasters.least), shares(rasters.most)};
}

}  // namespace clpv::reference
