// SPDX-License-Identifier: MIT
// A triangle's values between its vertices, on the host.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/emission.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

inline constexpr int kSamples = 8;          // of a cell's face along each axis, where triangles are sampled
inline constexpr double kSeam = 1.0 / 256;  // [samples] outside an edge that still count
/// Alpha within this of the cut-off is undecided: a texture's step between texels magnifies a sample's rounding.
inline constexpr double kAlphaHair = 0.03;

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

/// get(vertex) between the vertices; `weights` of the second and the third.
template <typename Get>
auto interpolate(const Scene& scene, const Triangle& triangle, const glm::vec2& weights, Get get) {
  return (1 - weights.x - weights.y) * get(scene.vertices[triangle.vertex[0]]) +
         weights.x * get(scene.vertices[triangle.vertex[1]]) +
         weights.y * get(scene.vertices[triangle.vertex[2]]);
}

}  // namespace clpv::reference
