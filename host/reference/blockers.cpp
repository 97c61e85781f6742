// SPDX-License-Identifier: MIT
// B_a: share of the square s x s across axis a, about a corner, that triangles inside the cube s^3
// about the corner cover. 8 x 8 samples per corner and axis.

#include "reference/blockers.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <utility>
#include <vector>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "reference/materials.hpp"
#include "reference/view.hpp"

namespace clpv::reference {

// A triangle projected along an axis of a grid and sampled, as in kernels/voxels/blockers.cl and
// kernels/voxels/reflectors.cl.

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

  /// Selects the side that faces up or down the axis, and moves the triangle so far to that side
  /// that centres of its cells are in front of it.
  void lift(bool up) {
    if (up != this->up()) normal_ = -normal_;
    const glm::dvec3 aside = normal_ / (2 * weight());
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

// R_a: covered share of face a times mean albedo; channel 3: the mean share m of its triangles,
// channel 4: R of albedo 1; by 8 x 8 samples per face, off the surface. A triangle of normal n
// counts towards the three axes next to n with weights |n_a| / (|n_x| + |n_y| + |n_z|).

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

constexpr int kCubePoints = 4;  // per cube along each axis
// [cells]: points this far outside an edge count as inside.
constexpr double kVisibilitySeam = 1e-3;
constexpr double kVisibilityTolerance = 4e-4;  // [cells]: rounding error of float32
// [cells]: centres and points lie off walls at round coordinates.
constexpr glm::dvec3 kOffGrid(2.0e-3, 3.3e-3, 4.7e-3);

using Corners = std::array<glm::dvec3, 3>;  // [cells] from the first cell's centre

/// Margin [cells] by which the segment from `from` to `to` crosses a triangle; negative if it does
/// not. The minimum of the distance to the plane beyond the cut and the distances to the edges.
double crossing(const Corners& t, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]), segment = to - from;
  const double size = glm::length(normal), along = glm::dot(normal, segment),
               distance = glm::dot(normal, t[0] - from);
  if (size == 0 || along == 0 || distance / along < 0) return -1;
  const glm::dvec3 cut = from + segment * (distance / along);
  double margin = (std::abs(along) - std::abs(distance)) / size;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 a = t[i], edge = t[(i + 1) % 3] - a;
    // A barycentric coordinate.
    const double inside = glm::dot(glm::cross(edge, cut - a), normal) / (size * size);
    const double breadth = std::abs(edge.x) + std::abs(edge.y) + std::abs(edge.z);
    margin = std::min(margin, inside * std::abs(along) / breadth + kVisibilitySeam);
  }
  // A plane through the start point hides nothing; rounding decides its side.
  return std::abs(distance) / size < kVisibilityTolerance ? std::min(margin, 0.0) : margin;
}

/// Adds the segments of one cube that a triangle crosses.
void add(Occlusion& occluded, int n, const Corners& t, const glm::ivec3& cube) {
  const std::size_t first =
      ((cube.z * n + cube.y) * n + cube.x) * kCubePoints * kCubePoints * kCubePoints;
  for (int point = 0; point < kCubePoints * kCubePoints * kCubePoints; ++point) {
    const glm::dvec3 at(point % kCubePoints, point / kCubePoints % kCubePoints,
                        point / kCubePoints / kCubePoints);
    const glm::dvec3 to = glm::dvec3(cube) + (at + 0.5) / double{kCubePoints};
    for (int corner = 0; corner < 8; ++corner) {
      const double margin =
          crossing(t, glm::dvec3(cube + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2)), to);
      const std::uint8_t bit = 1u << corner;
      if (margin > kVisibilityTolerance)
        occluded.lower[first + static_cast<std::size_t>(point)] |= bit;
      if (margin >= -kVisibilityTolerance)
        occluded.upper[first + static_cast<std::size_t>(point)] |= bit;
    }
  }
}

}  // namespace

BlockerBounds voxelize_blockers(const SceneData& scene, const ClpvGrid& grid) {
  BlockerRaster raster(scene, grid);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) raster.add(t);
  return {raster.lower.shares(), raster.upper.shares()};
}

ReflectingAreas voxelize_reflectors(const SceneData& scene, const ClpvGrid& grid, bool white) {
  CellFaces faces(scene, grid, white);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) faces.add(t);
  return faces.areas();
}

Occlusion occlude(const SceneData& scene, const ClpvGrid& grid) {
  const int n = grid.n;
  const auto bytes = static_cast<std::size_t>(n) * n * n * kCubePoints * kCubePoints * kCubePoints;
  Occlusion occluded{std::vector<std::uint8_t>(bytes), std::vector<std::uint8_t>(bytes)};
  for (const Triangle& triangle : scene.triangles) {
    if ((scene.materials[triangle.material].flags & CLPV_MATERIAL_MASKED) != 0) continue;
    Corners t = corners_of(scene, triangle);
    for (glm::dvec3& at : t) at = (at - vector(grid.origin)) / double{grid.cell} - 0.5 - kOffGrid;
    const glm::dvec3 low = glm::min(t[0], glm::min(t[1], t[2])),
                     high = glm::max(t[0], glm::max(t[1], t[2]));
    const glm::ivec3 first(glm::clamp(glm::floor(low - kVisibilityTolerance), 0.0, n - 1.0)),
        last(glm::clamp(glm::floor(high + kVisibilityTolerance), -1.0, n - 2.0));
    for (int z = first.z; z <= last.z; ++z) {
      for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) add(occluded, n, t, {x, y, z});
      }
    }
  }
  return occluded;
}

}  // namespace clpv::reference
