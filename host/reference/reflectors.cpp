// SPDX-License-Identifier: MIT
#include "reference/reflectors.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "basis/bounce.hpp"
#include "reference/facing.hpp"
#include "reference/materials.hpp"

namespace clpv::reference {
namespace {

constexpr double kReflectHair = 4e-3;  // [samples], [cells / 8]: what float32 may decide either way

/// What is counted of a cell's side.
struct Side {
  std::bitset<kSamples * kSamples> covered;
  double samples = 0;
  glm::dvec3 colour{0};
  double unsure = 0, unsure_of_mean = 0;  ///< samples; those whose share in the mean is not known either
};

/// Samples of a row, in one cell.
struct Row {
  std::vector<int> columns;
  bool unsure = false;
};

class Sides {
 public:
  Sides(const Scene& scene, const ClpvGrid& grid)
      : scene_(scene),
        materials_(scene),
        grid_(grid),
        n_(static_cast<int>(grid.n)),
        sides_(static_cast<std::size_t>(n_ * n_ * n_ * kReflectingSides)) {}

  void add(std::uint32_t triangle) {
    std::array<glm::dvec3, 3> corners = corners_of(scene_, scene_.triangles[triangle]);
    for (glm::dvec3& c : corners) c = (c - vector(grid_.origin)) / double{grid_.cell};
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool up : {true, false}) {
        Facing facing(axis, corners);
        if (!facing.seen()) continue;
        facing.lift(up);
        add(triangle, facing);
      }
    }
  }

  Reflected areas() const {
    Reflected result{Volume(n_, kReflectingSides), Volume(n_, kReflectingSides)};
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const Side& side = sides_[i];
      const double count = std::max(side.samples, 1.0), whole = kSamples * kSamples;
      const int side_number = i % kReflectingSides;
      const int cell = i / kReflectingSides;
      double share = static_cast<double>(side.covered.count()) / whole, unsure = side.unsure / whole;
      for (int other = 0; other < kReflectingSides; ++other) {
        if (other / 2 == side_number / 2) continue;
        const Side& across = sides_[cell * kReflectingSides + other];
        share *= 1 - edge_loss() * static_cast<double>(across.covered.count()) / whole;
        unsure += across.unsure / whole;
      }
      for (int channel = 0; channel < 3; ++channel) {
        const int x = cell % n_, y = cell / n_ % n_, z = cell / n_ / n_;
        result.areas.at(channel, side_number, x, y, z) = share * std::min(side.colour[channel] / count, 1.0);
        result.doubt.at(channel, side_number, x, y, z) = unsure + side.unsure_of_mean / count;
      }
    }
    return result;
  }

 private:
  Side& side(const Facing& facing, int i, int j, int k) {
    const glm::ivec3 cell = facing.cell(i, j, k);
    const int number = (cell.z * n_ + cell.y) * n_ + cell.x;
    return sides_[number * kReflectingSides + 2 * facing.axis() + (facing.up() ? 0 : 1)];
  }

  void add(std::uint32_t triangle, const Facing& facing) {
    const auto [left, right] = facing.range(0, n_);
    const auto [top, bottom] = facing.range(1, n_);
    for (int v = top; v <= bottom; ++v) {
      for (int i = left / kSamples; i <= right / kSamples && left <= right; ++i) {
        std::map<int, Row> rows;  // by cell
        for (int u = i * kSamples; u < (i + 1) * kSamples; ++u) look(triangle, facing, u, v, rows);
        for (const auto& [k, row] : rows) {
          if (k >= 0 && k < n_) add_row(triangle, facing, row, i, v, k);
        }
      }
    }
  }

  /// Puts a sample into the cells that it may be in.
  void look(std::uint32_t triangle, const Facing& facing, int u, int v, std::map<int, Row>& rows) const {
    const glm::dvec2 at = middle_of_sample(u, v);
    const double within = facing.inside(at);
    if (within < -kReflectHair) return;
    const double solid = materials_.solidity({triangle, facing.weights_inside(at)});
    if (solid < -kAlphaHair) return;
    const auto [nearest, farthest] = facing.depths();
    const glm::dvec2 slope = facing.slope();
    const double steep = kReflectHair * (1 + std::abs(slope.x) + std::abs(slope.y));
    const double depth = facing.depth(at);
    const int first = std::floor(std::clamp(depth - steep, nearest - kReflectHair, farthest + kReflectHair));
    const int last = std::floor(std::clamp(depth + steep, nearest - kReflectHair, farthest + kReflectHair));
    const bool sure = within > kReflectHair && solid > kAlphaHair && first == last;
    for (int k = first; k <= last; ++k) {
      Row& row = rows[k];
      row.unsure = row.unsure || !sure;
      if (within >= 0 && solid >= 0 && k == static_cast<int>(std::floor(depth))) row.columns.push_back(u);
    }
  }

  void add_row(std::uint32_t triangle, const Facing& facing, const Row& row, int i, int v, int k) {
    Side& to = side(facing, i, v / kSamples, k);
    const double count = row.columns.size();
    if (row.unsure) to.unsure += kSamples, to.unsure_of_mean += kSamples;
    if (count == 0) return;
    double middle = 0;
    for (const int u : row.columns) {
      to.covered.set(static_cast<std::size_t>(v % kSamples * kSamples + u % kSamples));
      middle += u / count;
    }
    const glm::dvec2 at = middle_of_sample(middle, v);
    const SurfacePoint point{triangle, facing.weights_inside(at)};
    const glm::dvec3 albedo(materials_.albedo(point, {step(facing, 1, count), step(facing, 2, 1)}));
    to.samples += count;
    to.colour += count * facing.weight() * glm::clamp(albedo, 0.0, 1.0);
  }

  /// From sample to sample `count` times, along u (1) or v (2), on the triangle's plane [m].
  glm::dvec3 step(const Facing& facing, int along, double count) const {
    glm::dvec3 by(0);
    by[(facing.axis() + along) % 3] = 1.0 / kSamples;
    by[facing.axis()] = along == 1 ? facing.slope().x : facing.slope().y;
    return count * double{grid_.cell} * by;
  }

  const Scene& scene_;
  Materials materials_;
  const ClpvGrid& grid_;
  int n_;
  std::vector<Side> sides_;
};

}  // namespace

Reflected reflect(const Scene& scene, const ClpvGrid& grid) {
  Sides sides(scene, grid);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) sides.add(t);
  return sides.areas();
}

}  // namespace clpv::reference
