// SPDX-License-Identifier: MIT
// Interpolation of vertex attributes on triangles, and constants of sampling them.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/emission.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

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
