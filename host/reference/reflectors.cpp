// SPDX-License-Identifier: MIT
// R_a: covered share of face a times mean albedo; channel 3: the mean share m of its triangles,
// channel 4: R of albedo 1; by 8 x 8 samples per face, half a cell off the
// surface. A triangle of normal n counts towards the three axes next to n with weights |n_a| /
// (|n_x| + |n_y| + |n_z|).
#include "reference/reflectors.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "reference/axis_triangle.hpp"
#include "reference/materials.hpp"

namespace clpv::reference {
namespace {

constexpr double kReflectorTolerance = 4e-3;  // [samples], [cells / 8]: rounding error of float32

/// Sums of one face of a cell.
struct CellFace {
  std::bitset<kSamples * kSamples> covered;
  double samples = 0;
  glm::dvec4 colour{0};  ///< albedo, and 1, each times the triangle's share
  /// Uncertain samples, of the coverage and of the mean albedo.
  double uncertain = 0, uncertain_mean = 0;
};

/// Covered samples of one row in one cell.
struct Row {
  std::vector<int> columns;
  bool uncertain = false;
};

/// Accumulates triangles on the faces of all cells.
class CellFaces {
 public:
  CellFaces(const SceneData& scene, const ClpvGrid& grid, bool white)
      : scene_(scene),
        white_(white),
        materials_(scene),
        grid_(grid),
        n_(static_cast<int>(grid.n)),
        faces_(static_cast<std::size_t>(n_ * n_ * n_ * kCellFaces)) {}

  void add(std::uint32_t triangle) {
    std::array<glm::dvec3, 3> corners = corners_of(scene_, scene_.triangles[triangle]);
    for (glm::dvec3& c : corners) c = (c - vector(grid_.origin)) / double{grid_.cell};
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool up : {true, false}) {
        AxisTriangle projected(axis, corners);
        if (!projected.has_area() || (white_ && back(triangle, projected, up))) continue;
        projected.lift(up);
        add(triangle, projected);
      }
    }
  }

  ReflectingAreas areas() const {
    ReflectingAreas result{Volume(n_, kCellFaces, CLPV_REFLECTOR_CHANNELS),
                           Volume(n_, kCellFaces, CLPV_REFLECTOR_CHANNELS)};
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const CellFace& side = faces_[i];
      const double count = std::max(side.samples, 1.0), whole = kSamples * kSamples;
      const int number = i % kCellFaces;
      const int cell = i / kCellFaces;
      const double share = static_cast<double>(side.covered.count()) / whole,
                   uncertain = side.uncertain / whole;
      for (int channel = 0; channel < CLPV_REFLECTOR_CHANNELS; ++channel) {
        const int x = cell % n_, y = cell / n_ % n_, z = cell / n_ / n_;
        const double mean =
            std::min(side.colour[std::min<int>(channel, CLPV_REFLECTOR_SHARE)] / count, 1.0);
        result.areas.at(channel, number, x, y, z) =
            channel == CLPV_REFLECTOR_SHARE ? mean : share * mean;
        result.tolerance.at(channel, number, x, y, z) = uncertain + side.uncertain_mean / count;
      }
    }
    return result;
  }

 private:
  CellFace& side(const AxisTriangle& projected, int i, int j, int k) {
    const glm::ivec3 cell = projected.cell(i, j, k);
    const int number = (cell.z * n_ + cell.y) * n_ + cell.x;
    return faces_[number * kCellFaces + 2 * projected.axis() + (projected.up() ? 0 : 1)];
  }

  void add(std::uint32_t triangle, const AxisTriangle& projected) {
    const auto [left, right] = projected.range(0, n_);
    const auto [top, bottom] = projected.range(1, n_);
    for (int v = top; v <= bottom; ++v) {
      for (int i = left / kSamples; i <= right / kSamples && left <= right; ++i) {
        std::map<int, Row> rows;  // by cell
        for (int u = i * kSamples; u < (i + 1) * kSamples; ++u)
          add_sample(triangle, projected, u, v, rows);
        for (const auto& [k, row] : rows) {
          if (k >= 0 && k < n_) add_row(triangle, projected, row, i, v, k);
        }
      }
    }
  }

  /// Adds a sample to the row of each cell that it may lie in.
  void add_sample(std::uint32_t triangle, const AxisTriangle& projected, int u, int v,
                  std::map<int, Row>& rows) const {
    const glm::dvec2 at = sample_centre(u, v);
    const double distance = projected.edge_distance(at);
    if (distance < -kReflectorTolerance) return;
    const double solid = materials_.solidity({triangle, projected.clamped_weights(at)});
    if (solid < -kAlphaTolerance) return;
    const auto [nearest, farthest] = projected.depths();
    const glm::dvec2 slope = projected.slope();
    const double steep = kReflectorTolerance * (1 + std::abs(slope.x) + std::abs(slope.y));
    const double depth = projected.depth(at);
    const int first = std::floor(
        std::clamp(depth - steep, nearest - kReflectorTolerance, farthest + kReflectorTolerance));
    const int last = std::floor(
        std::clamp(depth + steep, nearest - kReflectorTolerance, farthest + kReflectorTolerance));
    const bool certain = distance > kReflectorTolerance && solid > kAlphaTolerance && first == last;
    for (int k = first; k <= last; ++k) {
      Row& row = rows[k];
      row.uncertain = row.uncertain || !certain;
      if (distance >= 0 && solid >= 0 && k == static_cast<int>(std::floor(depth)))
        row.columns.push_back(u);
    }
  }

  void add_row(std::uint32_t triangle, const AxisTriangle& projected, const Row& row, int i, int v,
               int k) {
    CellFace& face = side(projected, i, v / kSamples, k);
    const double count = row.columns.size();
    if (row.uncertain) face.uncertain += kSamples, face.uncertain_mean += kSamples;
    if (count == 0) return;
    double middle = 0;
    for (const int u : row.columns) {
      face.covered.set(static_cast<std::size_t>(v % kSamples * kSamples + u % kSamples));
      middle += u / count;
    }
    const glm::dvec2 at = sample_centre(middle, v);
    const SurfacePoint point{triangle, projected.clamped_weights(at)};
    const glm::dvec3 albedo = white_
                                  ? glm::dvec3(0)
                                  : glm::dvec3(materials_.albedo(
                                        point, {step(projected, 1, count), step(projected, 2, 1)}));
    face.samples += count;
    face.colour += count * projected.weight() * glm::dvec4(glm::clamp(albedo, 0.0, 1.0), 1);
  }

  /// Offset of `count` samples along u (1) or v (2) on the triangle's plane [m].
  glm::dvec3 step(const AxisTriangle& projected, int along, double count) const {
    glm::dvec3 by(0);
    by[(projected.axis() + along) % 3] = 1.0 / kSamples;
    by[projected.axis()] = along == 1 ? projected.slope().x : projected.slope().y;
    return count * double{grid_.cell} * by;
  }

  /// The side of a one-sided triangle that faces away from its normal.
  bool back(std::uint32_t triangle, const AxisTriangle& projected, bool up) const {
    const Triangle& t = scene_.triangles[triangle];
    return projected.up() != up && !double_sided(scene_.materials[t.material]);
  }

  const SceneData& scene_;
  bool white_;
  Materials materials_;
  const ClpvGrid& grid_;
  int n_;
  std::vector<CellFace> faces_;
};

}  // namespace

ReflectingAreas voxelize_reflectors(const SceneData& scene, const ClpvGrid& grid, bool white) {
  CellFaces faces(scene, grid, white);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) faces.add(t);
  return faces.areas();
}

}  // namespace clpv::reference
