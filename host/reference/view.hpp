// SPDX-License-Identifier: MIT
// CPU reference of kernels/raster/surface.h: projection between pixels and world positions, in
// double.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "kernels/shared/view.h"
#include "scene/emission.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// z-component of the cross product.
inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Returns the world position [m] at depth [m] of pixel (px, py). Pixel centres have integer
/// coordinates.
glm::dvec3 surface_position(const ClpvView& view, double px, double py, double depth);
/// The same of the pixel with that number, row by row.
inline glm::dvec3 surface_position(const ClpvView& view, std::size_t pixel, double depth) {
  return surface_position(view, pixel % view.width, pixel / view.width, depth);
}

/// Returns the way [m] from `position` to the eye, or to its plane; 0 for points without a view.
glm::dvec3 towards_eye(const ClpvView& view, const glm::dvec3& position);

/// Projection of a point: pixel coordinates (pixel centres are integers) and depth [m]. In
/// perspective views valid for depth > 0.
struct ProjectedPoint {
  glm::dvec2 pixel{0};
  double depth = 0;
};
ProjectedPoint project(const ClpvView& view, const glm::dvec3& point);

/// Returns the distance [m] between adjacent pixels' positions on a plane across `forward` at
/// `depth` [m].
double pixel_edge(const ClpvView& view, double depth);

/// Returns the area [m^2] of a pixel's footprint across its ray; perspective: distance^2 times the
/// pixel's solid angle.
double footprint(const ClpvView& view, double px, double py, double depth);

// Interpolation of vertex attributes on triangles, and constants of sampling them.

inline constexpr int kSamples = 8;  // per cell face along each axis
// [samples]: points this far outside an edge count as inside.
inline constexpr double kSeam = 1.0 / 256;
/// Alpha closer than this to the cutoff is uncertain: texture gradients amplify rounding errors of
/// the sample's position.
inline constexpr double kAlphaTolerance = 0.03;

inline glm::vec3 position(const Vertex& v) {
  return {v.position[0], v.position[1], v.position[2]};
}
inline glm::vec3 normal(const Vertex& v) {
  return {v.normal[0], v.normal[1], v.normal[2]};
}
inline glm::vec2 coordinates(const Vertex& v) {
  return {v.uv[0], v.uv[1]};
}
inline glm::vec4 colour(const Vertex& v) {
  return {v.colour[0], v.colour[1], v.colour[2], v.colour[3]};
}

/// Interpolates get(vertex); `weights` are barycentric coordinates of the second and third vertex.
/// Equal values at all three vertices are returned exactly.
template <typename Get>
auto interpolate(const SceneData& scene, const Triangle& triangle, const glm::vec2& weights,
                 Get get) {
  const auto first = get(scene.vertices[triangle.vertex[0]]);
  return first + weights.x * (get(scene.vertices[triangle.vertex[1]]) - first) +
         weights.y * (get(scene.vertices[triangle.vertex[2]]) - first);
}

}  // namespace clpv::reference
