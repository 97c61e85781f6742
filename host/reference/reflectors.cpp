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
#include "reference/materials.hpp"
#include "reference/triangle.hpp"

namespace clpv::reference {
namespace {

constexpr double kReflectHair = 4e-3;  // [samples], [cells / 8]: what float32 may decide either way
constexpr double kAlphaHair = 0.03;    // as in block.cpp

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

/// A triangle seen along an axis, where its side that faces up that axis (`up`), or down, is lit. In cells of the grid.
class Facing {
 public:
  Facing(int axis, bool up, const std::array<glm::dvec3, 3>& corners) : axis_(axis), corners_(corners) {
    for (glm::dvec3& c : corners_) c = {c[(axis + 1) % 3], c[(axis + 2) % 3], c[axis]};
    const glm::dvec3 across = glm::cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
    area_ = across.z;
    if (area_ == 0) return;
    normal_ = glm::normalize(across) * (up == (across.z > 0) ? 1.0 : -1.0);
    const glm::dvec3 aside = normal_ / 2.0;
    for (glm::dvec3& c : corners_)
      c += glm::dvec3(std::rint(kSamples * aside.x) / kSamples, std::rint(kSamples * aside.y) / kSamples,
                      aside.z);
  }

  bool seen() const { return area_ != 0; }
  int axis() const { return axis_; }
  /// Area that a sample stands for, in samples: all axes of a triangle together count its area once.
  double weight() const { return 1 / (std::abs(normal_.x) + std::abs(normal_.y) + std::abs(normal_.z)); }
  glm::dvec2 weights(const glm::dvec2& at) const {
    const glm::dvec2 from = at - glm::dvec2(corners_[0]);
    const glm::dvec2 e1(corners_[1] - corners_[0]), e2(corners_[2] - corners_[0]);
    return glm::dvec2(from.x * e2.y - from.y * e2.x, e1.x * from.y - e1.y * from.x) / area_;
  }
  double depth(const glm::dvec2& at) const {
    const glm::dvec2 w = weights(at);
    return corners_[0].z + w.x * (corners_[1].z - corners_[0].z) + w.y * (corners_[2].z - corners_[0].z);
  }
  std::pair<double, double> depths() const {
    return std::minmax({corners_[0].z, corners_[1].z, corners_[2].z});
  }
  /// How far inside a point is [samples]; the least over the edges, their seams included.
  double inside(const glm::dvec2& at) const {
    double least = 1e300;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 a(corners_[i]), edge = glm::dvec2(corners_[(i + 1) % 3]) - a, from = at - a;
      const double across = (area_ < 0 ? -1 : 1) * (edge.x * from.y - edge.y * from.x);
      least = std::min(least, kSamples * across / (std::abs(edge.x) + std::abs(edge.y)) + kSeam);
    }
    return least;
  }
  /// Change of depth from sample to sample along u and v [cells].
  glm::dvec2 slope() const { return glm::dvec2(normal_.x, normal_.y) / -normal_.z / double{kSamples}; }
  /// The samples that may be covered along u or v, of those of `n` cells: from first to last.
  std::pair<int, int> range(int along, int n) const {
    const auto [low, high] = std::minmax({corners_[0][along], corners_[1][along], corners_[2][along]});
    const double last = kSamples * n - 1;
    return {static_cast<int>(std::clamp(std::floor(kSamples * low - 1), 0.0, last + 1)),
            static_cast<int>(std::clamp(std::ceil(kSamples * high), -1.0, last))};
  }
  bool up() const { return normal_.z > 0; }

 private:
  int axis_;
  std::array<glm::dvec3, 3> corners_;  ///< along u, v and the axis
  double area_ = 0;                    ///< twice its projection's
  glm::dvec3 normal_{0};
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
    const Triangle& t = scene_.triangles[triangle];
    std::array<glm::dvec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] =
          (glm::dvec3(position(scene_.vertices[t.vertex[i]])) - vector(grid_.origin)) / double{grid_.cell};
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool up : {true, false}) {
        const Facing facing(axis, up, corners);
        if (facing.seen()) add(triangle, facing);
      }
    }
  }

  Reflected areas() const {
    Reflected result{Volume(n_, kReflectingSides), Volume(n_, kReflectingSides)};
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const Side& side = sides_[i];
      const double count = std::max(side.samples, 1.0), whole = kSamples * kSamples;
      const int side_number = static_cast<int>(i % kReflectingSides);
      const auto cell = static_cast<int>(i / kReflectingSides);
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
    glm::ivec3 cell;
    cell[(facing.axis() + 1) % 3] = i, cell[(facing.axis() + 2) % 3] = j, cell[facing.axis()] = k;
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
    const glm::dvec2 at = (glm::dvec2(u, v) + 0.5) / double{kSamples};
    const double within = facing.inside(at);
    if (within < -kReflectHair) return;
    const double solid = materials_.solidity({triangle, on_triangle(facing.weights(at))});
    if (solid < -kAlphaHair) return;
    const auto [nearest, farthest] = facing.depths();
    const glm::dvec2 slope = facing.slope();
    const double steep = kReflectHair * (1 + std::abs(slope.x) + std::abs(slope.y));
    const double depth = std::clamp(facing.depth(at), nearest, farthest);
    const int first = static_cast<int>(
        std::floor(std::clamp(depth - steep, nearest - kReflectHair, farthest + kReflectHair)));
    const int last = static_cast<int>(
        std::floor(std::clamp(depth + steep, nearest - kReflectHair, farthest + kReflectHair)));
    const bool sure = within > kReflectHair && solid > kAlphaHair && first == last;
    for (int k = first; k <= last; ++k) {
      Row& row = rows[k];
      row.unsure = row.unsure || !sure;
      if (within >= 0 && solid >= 0 && k == static_cast<int>(std::floor(depth))) row.columns.push_back(u);
    }
  }

  static glm::vec2 on_triangle(const glm::dvec2& weights) {
    const double x = std::clamp(weights.x, 0.0, 1.0);
    return {x, std::clamp(weights.y, 0.0, 1 - x)};
  }

  void add_row(std::uint32_t triangle, const Facing& facing, const Row& row, int i, int v, int k) {
    Side& to = side(facing, i, v / kSamples, k);
    const auto count = static_cast<double>(row.columns.size());
    if (row.unsure) to.unsure += kSamples, to.unsure_of_mean += kSamples;
    if (count == 0) return;
    double middle = 0;
    for (const int u : row.columns) {
      to.covered.set(static_cast<std::size_t>(v % kSamples * kSamples + u % kSamples));
      middle += u / count;
    }
    const glm::dvec2 at = (glm::dvec2(middle, v) + 0.5) / double{kSamples};
    const SurfacePoint point{triangle, on_triangle(facing.weights(at))};
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
