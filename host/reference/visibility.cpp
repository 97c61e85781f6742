// SPDX-License-Identifier: MIT
#include "reference/visibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "reference/triangle.hpp"

namespace clpv::reference {
namespace {

constexpr int kCubePoints = 4;  // per cube along each axis
// [cells]: points this far outside an edge count as inside.
constexpr double kVisibilitySeam = 1e-3;
constexpr double kVisibilityTolerance = 4e-4;  // [cells]: rounding error of float32

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

Occlusion occlude(const SceneData& scene, const ClpvGrid& grid) {
  const int n = grid.n;
  const auto bytes = static_cast<std::size_t>(n) * n * n * kCubePoints * kCubePoints * kCubePoints;
  Occlusion occluded{std::vector<std::uint8_t>(bytes), std::vector<std::uint8_t>(bytes)};
  for (const Triangle& triangle : scene.triangles) {
    if ((scene.materials[triangle.material].flags & CLPV_MATERIAL_MASKED) != 0) continue;
    Corners t = corners_of(scene, triangle);
    for (glm::dvec3& at : t) at = (at - vector(grid.origin)) / double{grid.cell} - 0.5;
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
