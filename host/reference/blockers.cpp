// SPDX-License-Identifier: MIT
#include "reference/blockers.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "reference/facing.hpp"
#include "reference/materials.hpp"

namespace clpv::reference {
namespace {

constexpr double kHair = 2e-3;  // [samples], [cells / 8]: what float32 may decide either way

/// Which samples of each corner and axis are covered.
class SampleMasks {
 public:
  explicit SampleMasks(int corners) : n_(corners), bits_(3 * corners * corners * corners) {}

  /// A sample of row v and column u, at corner k along the axis that it is seen along.
  void set(const Facing& facing, int u, int v, int k) {
    if (k < 0 || k >= n_) return;
    const glm::ivec3 c = facing.cell(u / kSamples, v / kSamples, k);
    bits_[((facing.axis() * n_ + c.z) * n_ + c.y) * n_ + c.x].set(v % kSamples * kSamples + u % kSamples);
  }

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

class Rasters {
 public:
  Rasters(const Scene& scene, const ClpvGrid& grid)
      : least(static_cast<int>(grid.n) + 1), most(least), scene_(scene), materials_(scene), grid_(grid) {}

  SampleMasks least, most;

  void add(std::uint32_t triangle) {
    std::array<glm::dvec3, 3> corners = corners_of(scene_, scene_.triangles[triangle]);
    for (glm::dvec3& c : corners) c = (c - vector(grid_.origin)) / double{grid_.cell} + 0.5;
    for (int axis = 0; axis < 3; ++axis) {
      const Facing facing(axis, corners);
      if (!facing.seen()) continue;
      const auto [left, right] = facing.range(0, grid_.n + 1);
      const auto [top, bottom] = facing.range(1, grid_.n + 1);
      for (int v = top; v <= bottom; ++v) {
        for (int u = left; u <= right; ++u) add_sample(triangle, facing, u, v);
      }
    }
  }

 private:
  void add_sample(std::uint32_t triangle, const Facing& facing, int u, int v) {
    const glm::dvec2 at = middle_of_sample(u, v);
    const double within = facing.inside(at);
    if (within < -kHair) return;
    const double solid = materials_.solidity({triangle, facing.weights_inside(at)});
    if (solid < -kAlphaHair) return;
    const bool sure = within > kHair && solid > kAlphaHair;
    // Steep triangles err most in depth where rounding moves the sample.
    const glm::dvec2 slope = glm::abs(facing.slope());
    const auto [nearest, farthest] = facing.depths();
    const double steep = std::min(farthest - nearest, kHair * std::max(1.0, slope.x + slope.y));
    const double depth = facing.depth(at), hair = kHair / kSamples + steep;
    const int first = std::floor(depth - hair), last = std::floor(depth + hair);
    for (int k = first; k <= last; ++k) most.set(facing, u, v, k);
    if (sure && first == last) least.set(facing, u, v, first);
  }

  const Scene& scene_;
  Materials materials_;
  const ClpvGrid& grid_;
};

}  // namespace

Blocked block(const Scene& scene, const ClpvGrid& grid) {
  Rasters rasters(scene, grid);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) rasters.add(t);
  return {rasters.least.shares(), rasters.most.shares()};
}

}  // namespace clpv::reference
