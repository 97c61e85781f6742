// SPDX-License-Identifier: MIT
#include "reference/emit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/materials.hpp"
#include "reference/triangle.hpp"

namespace clpv::reference {
namespace {

/// A triangle inside another, similar to it or (edge < 0) inverted. Corner and edge are in the
/// outer triangle's barycentric coordinates.
struct SubTriangle {
  glm::dvec2 corner{0};
  double edge = 1;

  glm::dvec2 centroid() const { return corner + edge / 3; }

  /// Divides the triangle into rows^2 similar ones, row by row from the first corner.
  std::vector<SubTriangle> divided(int rows) const {
    std::vector<SubTriangle> sub_triangles;
    const double step = edge / rows;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column <= row; ++column) {
        sub_triangles.push_back({corner + step * glm::dvec2(row - column, column), step});
        if (column < row)
          sub_triangles.push_back({corner + step * glm::dvec2(row - column, column + 1), -step});
      }
    }
    return sub_triangles;
  }
};

/// Emission of one triangle.
class EmissiveTriangle {
 public:
  EmissiveTriangle(const SceneData& scene, const Materials& materials, std::uint32_t triangle)
      : materials_(materials), index_(triangle) {
    const std::array<glm::dvec3, 3> corners = corners_of(scene, scene.triangles[triangle]);
    first_ = corners[0], to_second_ = corners[1] - first_, to_third_ = corners[2] - first_;
    normal_ = glm::cross(to_second_, to_third_);
  }

  EmittedPoint point(const SubTriangle& sub_triangle, double side) const {
    EmittedPoint point;
    const double twice_area = glm::length(normal_);
    if (twice_area == 0) return point;
    const glm::dvec2 w = sub_triangle.centroid();
    point.position = first_ + w.x * to_second_ + w.y * to_third_;
    point.normal = side / twice_area * normal_;
    const std::vector<SubTriangle> samples = sub_triangle.divided(CLPV_EMIT_SAMPLES);
    const double flux = std::numbers::pi * twice_area / 2 * sub_triangle.edge * sub_triangle.edge /
                        static_cast<double>(samples.size());
    for (const SubTriangle& sample : samples) {
      const glm::dvec3 emitted = flux * radiance(sample);
      const double solid = materials_.solidity({index_, glm::vec2(sample.centroid())});
      if (solid >= 0) point.flux += emitted;
      if (std::abs(solid) < kAlphaTolerance)
        point.tolerance += std::max({emitted.x, emitted.y, emitted.z});
    }
    return point;
  }

 private:
  /// Filtered radiance of a sample [W/m^2/sr].
  glm::dvec3 radiance(const SubTriangle& sample) const {
    const double width = double{CLPV_EMIT_FOOTPRINT} * sample.edge;
    return glm::dvec3(materials_.emissive({index_, glm::vec2(sample.centroid())},
                                          {width * to_second_, width * to_third_}));
  }

  const Materials& materials_;
  std::uint32_t index_;
  glm::dvec3 first_, to_second_, to_third_, normal_;
};

}  // namespace

std::vector<EmittedPoint> emit(const SceneData& scene, const EmissionPlan& plan) {
  const Materials materials(scene);
  std::vector<EmittedPoint> points;
  for (const ClpvEmitter& emitter : plan.parts) {
    const EmissiveTriangle triangle(scene, materials, emitter.triangle);
    const SubTriangle whole{{emitter.u, emitter.v}, emitter.size};
    for (const SubTriangle& sub_triangle : whole.divided(static_cast<int>(emitter.rows)))
      points.push_back(triangle.point(sub_triangle, double{emitter.side}));
  }
  return points;
}

}  // namespace clpv::reference
