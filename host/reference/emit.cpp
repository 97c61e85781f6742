// SPDX-License-Identifier: MIT
#include "reference/emit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/materials.hpp"
#include "reference/triangle.hpp"

namespace clpv::reference {
namespace {

/// A triangle cut out of another, alike or turned round: its first corner and its edges, by that one's weights.
struct Piece {
  glm::dvec2 corner{0};
  double edge = 1;

  glm::dvec2 middle() const { return corner + edge / 3; }

  /// The rows^2 pieces that it falls into, row by row from the first corner.
  std::vector<Piece> cut(int rows) const {
    std::vector<Piece> pieces;
    const double step = edge / rows;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column <= row; ++column) {
        pieces.push_back({corner + step * glm::dvec2(row - column, column), step});
        if (column < row) pieces.push_back({corner + step * glm::dvec2(row - column, column + 1), -step});
      }
    }
    return pieces;
  }
};

/// What a triangle emits.
class Glow {
 public:
  Glow(const Scene& scene, const Materials& materials, std::uint32_t triangle)
      : materials_(materials), index_(triangle) {
    const std::array<glm::dvec3, 3> corners = corners_of(scene, scene.triangles[triangle]);
    first_ = corners[0], to_second_ = corners[1] - first_, to_third_ = corners[2] - first_;
    across_ = glm::cross(to_second_, to_third_);
  }

  EmittedPoint point(const Piece& piece, double side) const {
    EmittedPoint point;
    const double twice = glm::length(across_);
    if (twice == 0) return point;
    const glm::dvec2 w = piece.middle();
    point.position = first_ + w.x * to_second_ + w.y * to_third_;
    point.normal = side / twice * across_;
    const std::vector<Piece> looks = piece.cut(CLPV_EMIT_LOOKS);
    const double flux =
        std::numbers::pi * twice / 2 * piece.edge * piece.edge / static_cast<double>(looks.size());
    for (const Piece& look : looks) {
      const glm::dvec3 there = flux * seen(look);
      const double solid = materials_.solidity({index_, glm::vec2(look.middle())});
      if (solid >= 0) point.flux += there;
      if (std::abs(solid) < kAlphaHair) point.doubt += std::max({there.x, there.y, there.z});
    }
    return point;
  }

 private:
  glm::dvec3 seen(const Piece& look) const {
    const double reach = double{CLPV_EMIT_FOOTPRINT} * look.edge;
    return glm::dvec3(
        materials_.emissive({index_, glm::vec2(look.middle())}, {reach * to_second_, reach * to_third_}));
  }

  const Materials& materials_;
  std::uint32_t index_;
  glm::dvec3 first_, to_second_, to_third_, across_;
};

}  // namespace

std::vector<EmittedPoint> emit(const Scene& scene, const EmissionPlan& plan) {
  const Materials materials(scene);
  std::vector<EmittedPoint> points;
  for (const ClpvEmitter& part : plan.parts) {
    const Glow glow(scene, materials, part.triangle);
    const Piece whole{{part.u, part.v}, part.size};
    for (const Piece& piece : whole.cut(static_cast<int>(part.rows)))
      points.push_back(glow.point(piece, double{part.side}));
  }
  return points;
}

}  // namespace clpv::reference
