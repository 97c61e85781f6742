// SPDX-License-Identifier: MIT
// B_a: share of the square s x s across axis a, about a corner, that triangles inside the cube s^3
// about the corner cover. 8 x 8 samples per corner and axis.
#include "reference/blockers.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "reference/axis_triangle.hpp"
#include "reference/materials.hpp"

namespace clpv::reference {
namespace {

constexpr double kBlockerTolerance = 2e-3;  // [samples], [cells / 8]: rounding error of float32

/// Masks of covered samples: one per corner and axis.
class SampleMasks {
 public:
  explicit SampleMasks(int corners) : n_(corners), bits_(3 * corners * corners * corners) {}

  /// Sets sample (u, v) at corner k along the axis of projection.
  void set(const AxisTriangle& projected, int u, int v, int k) {
    if (k < 0 || k >= n_) return;
    const glm::ivec3 c = projected.cell(u / kSamples, v / kSamples, k);
    bits_[((projected.axis() * n_ + c.z) * n_ + c.y) * n_ + c.x].set(v % kSamples * kSamples +
                                                                     u % kSamples);
  }

  /// Covered share of each corner and axis.
  Volume shares() const {
    Volume volume(n_, 3, 1);
    for (std::size_t i = 0; i < bits_.size(); ++i)
      volume.values[i] = static_cast<double>(bits_[i].count()) / (kSamples * kSamples);
    return volume;
  }

 private:
  int n_;
  std::vector<std::bitset<kSamples * kSamples>> bits_;  ///< [axis][z][y][x]
};

/// Samples triangles along the three axes and sets the bits that they cover.
class BlockerRaster {
 public:
  BlockerRaster(const SceneData& scene, const ClpvGrid& grid)
      : lower(static_cast<int>(grid.n) + 1),
        upper(lower),
        scene_(scene),
        materials_(scene),
        grid_(grid) {}

  SampleMasks lower, upper;  ///< without and with uncertain samples

  void add(std::uint32_t triangle) {
    std::array<glm::dvec3, 3> corners = corners_of(scene_, scene_.triangles[triangle]);
    for (glm::dvec3& c : corners) c = (c - vector(grid_.origin)) / double{grid_.cell} + 0.5;
    for (int axis = 0; axis < 3; ++axis) {
      const AxisTriangle projected(axis, corners);
      if (!projected.has_area()) continue;
      const auto [left, right] = projected.range(0, grid_.n + 1);
      const auto [top, bottom] = projected.range(1, grid_.n + 1);
      for (int v = top; v <= bottom; ++v) {
        for (int u = left; u <= right; ++u) add_sample(triangle, projected, u, v);
      }
    }
  }

 private:
  void add_sample(std::uint32_t triangle, const AxisTriangle& projected, int u, int v) {
    const glm::dvec2 at = sample_centre(u, v);
    const double distance = projected.edge_distance(at);
    if (distance < -kBlockerTolerance) return;
    const double solid = materials_.solidity({triangle, projected.clamped_weights(at)});
    if (solid < -kAlphaTolerance) return;
    const bool certain = distance > kBlockerTolerance && solid > kAlphaTolerance;
    // On steep triangles, rounding of the sample's position changes the depth most.
    const glm::dvec2 slope = glm::abs(projected.slope());
    const auto [nearest, farthest] = projected.depths();
    const double steep =
        std::min(farthest - nearest, kBlockerTolerance * std::max(1.0, slope.x + slope.y));
    const double depth = projected.depth(at), error = kBlockerTolerance / kSamples + steep;
    const int first = std::floor(depth - error), last = std::floor(depth + error);
    for (int k = first; k <= last; ++k) upper.set(projected, u, v, k);
    if (certain && first == last) lower.set(projected, u, v, first);
  }

  const SceneData& scene_;
  Materials materials_;
  const ClpvGrid& grid_;
};

}  // namespace

BlockerBounds voxelize_blockers(const SceneData& scene, const ClpvGrid& grid) {
  BlockerRaster raster(scene, grid);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) raster.add(t);
  return {raster.lower.shares(), raster.upper.shares()};
}

}  // namespace clpv::reference
