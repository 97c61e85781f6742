// SPDX-License-Identifier: MIT
// Small scenes made in code, for tests.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "scene/scene.hpp"

namespace clpv::test {

inline unsigned add_material(SceneData& scene, const glm::vec3& albedo = glm::vec3(1),
                             unsigned flags = 0) {
  ClpvMaterial material{};
  for (int i = 0; i < 3; ++i) material.base_colour[i] = albedo[i];
  material.base_colour[3] = 1;
  material.texture = material.emissive_texture = CLPV_NO_TEXTURE;
  material.flags = flags;
  scene.materials.push_back(material);
  return static_cast<unsigned>(scene.materials.size() - 1);
}

inline unsigned add_vertex(SceneData& scene, const glm::vec3& p, const glm::vec3& normal,
                           const glm::vec2& uv = glm::vec2(0)) {
  scene.vertices.push_back(
      {{p.x, p.y, p.z}, {normal.x, normal.y, normal.z}, {uv.x, uv.y}, {1, 1, 1, 1}});
  return static_cast<unsigned>(scene.vertices.size() - 1);
}

/// Counter-clockwise a, b, c as its front is seen; its own three vertices with the face's normal.
inline void add_triangle(SceneData& scene, const glm::vec3& a, const glm::vec3& b,
                         const glm::vec3& c, unsigned material) {
  const glm::vec3 across = glm::cross(b - a, c - a);
  const glm::vec3 normal = glm::length(across) > 0 ? glm::normalize(across) : glm::vec3(0, 1, 0);
  const unsigned first = add_vertex(scene, a, normal);
  add_vertex(scene, b, normal);
  add_vertex(scene, c, normal);
  scene.triangles.push_back({{first, first + 1, first + 2}, material});
}

/// The parallelogram corner, corner + u, corner + u + v, corner + v, its front towards u x v; uv
/// from (0, 0) to (1, 1).
inline void add_quad(SceneData& scene, const glm::vec3& corner, const glm::vec3& u,
                     const glm::vec3& v, unsigned material) {
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  const unsigned first = add_vertex(scene, corner, normal, {0, 0});
  add_vertex(scene, corner + u, normal, {1, 0});
  add_vertex(scene, corner + u + v, normal, {1, 1});
  add_vertex(scene, corner + v, normal, {0, 1});
  scene.triangles.push_back({{first, first + 1, first + 2}, material});
  scene.triangles.push_back({{first, first + 2, first + 3}, material});
}

/// A cube from `low` on, its faces inwards.
inline void add_box(SceneData& scene, const glm::vec3& low, float edge, unsigned material) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 across(0), u(0), v(0);
    across[axis] = u[(axis + 1) % 3] = v[(axis + 2) % 3] = edge;
    add_quad(scene, low, u, v, material);
    add_quad(scene, low + across, v, u, material);
  }
}

/// A block of 1 x 2 x 1 m on a floor of 8 x 8 m, at `by`.
inline void add_block_on_floor(SceneData& scene, const glm::vec3& by, unsigned material) {
  add_quad(scene, glm::vec3(-4, 0, 4) + by, {8, 0, 0}, {0, 0, -8}, material);
  for (const glm::vec3 side : {glm::vec3(1, 0, 0), {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}) {
    const glm::vec3 across = glm::cross(glm::vec3(0, 1, 0), side);
    add_quad(scene, 0.5f * (side - across) + by, across, {0, 2, 0}, material);
  }
  add_quad(scene, glm::vec3(-0.5f, 2, 0.5f) + by, {1, 0, 0}, {0, 0, -1}, material);
}

/// A camera with y up.
inline SceneCamera camera_at(const glm::vec3& eye, const glm::vec3& along) {
  SceneCamera camera;
  camera.eye = eye, camera.forward = glm::normalize(along);
  camera.up =
      glm::normalize(glm::cross(glm::cross(camera.forward, glm::vec3(0, 1, 0)), camera.forward));
  return camera;
}

inline ClpvLight directional_light(const glm::vec3& direction,
                                   const glm::vec3& irradiance = glm::vec3(1)) {
  const glm::vec3 d = glm::normalize(direction);
  ClpvLight light{};
  light.kind = CLPV_LIGHT_DIRECTIONAL;
  for (int i = 0; i < 3; ++i) light.direction[i] = d[i];
  for (int i = 0; i < 3; ++i) light.intensity[i] = irradiance[i];
  return light;
}

inline ClpvLight point_light(const glm::vec3& position, const glm::vec3& intensity = glm::vec3(1)) {
  ClpvLight light{};
  light.kind = CLPV_LIGHT_POINT;
  for (int i = 0; i < 3; ++i) light.position[i] = position[i];
  for (int i = 0; i < 3; ++i) light.intensity[i] = intensity[i];
  return light;
}

/// As glTF's cone: full intensity inside `inner`, none beyond `outer` [rad].
inline ClpvLight spot_light(const glm::vec3& position, const glm::vec3& direction, float inner,
                            float outer) {
  ClpvLight light = point_light(position);
  const glm::vec3 d = glm::normalize(direction);
  light.kind = CLPV_LIGHT_SPOT;
  for (int i = 0; i < 3; ++i) light.direction[i] = d[i];
  light.cone_scale = 1 / std::max(0.001f, std::cos(inner) - std::cos(outer));
  light.cone_offset = -std::cos(outer) * light.cone_scale;
  return light;
}

}  // namespace clpv::test
