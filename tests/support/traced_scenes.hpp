// SPDX-License-Identifier: MIT
// Scenes for the tests of path tracing: floors, suns, lamps and cameras.
#pragma once

#include <limits>

#include "pathtracer/path_tracer.hpp"
#include "tests/support/scene_builder.hpp"

namespace clpv::test {

using pathtracer::PathTracerOptions;
using pathtracer::TracedImage;

/// A view along `forward`, its half extents the tangents of half the fields of view.
inline ClpvView view_of(glm::vec3 eye, glm::vec3 forward, glm::vec3 up, float half, unsigned width,
                        unsigned height) {
  const glm::vec3 f = glm::normalize(forward), r = glm::normalize(glm::cross(f, up)),
                  u = glm::cross(r, f);
  ClpvView view{};
  for (int i = 0; i < 3; ++i) {
    view.eye[i] = eye[i], view.right[i] = r[i], view.up[i] = u[i], view.forward[i] = f[i];
  }
  view.half_width = half, view.half_height = half * height / width;
  view.near_depth = 0.001f, view.far_depth = std::numeric_limits<float>::infinity();
  view.width = width, view.height = height;
  return view;
}

/// By the scene's own lights.
inline TracedImage trace_paths(const SceneData& scene, const ClpvView& view,
                               const PathTracerOptions& options) {
  return pathtracer::trace_paths(scene, scene.lights, view, options);
}

/// A material of one albedo.
inline unsigned add_grey(SceneData& scene, float albedo) {
  return add_material(scene, glm::vec3(albedo));
}

/// Irradiance across its direction [W/m^2], white.
inline SceneLight sun(const glm::vec3& direction, float irradiance) {
  return {"sun", directional_light(direction, glm::vec3(irradiance))};
}
/// Intensity [W/sr], white.
inline SceneLight lamp(const glm::vec3& position, float intensity) {
  return {"lamp", point_light(position, glm::vec3(intensity))};
}

/// Walls of a cube, seen from inside, that emit E and reflect a.
inline SceneData furnace(float albedo, float emitted, float edge = 1) {
  SceneData scene;
  scene.path = "furnace";
  add_grey(scene, albedo);
  for (float& e : scene.materials[0].emissive) e = emitted;
  add_box(scene, glm::vec3(0), edge, 0);
  return scene;
}

/// A horizontal square of edge 20 m round the origin, facing up.
inline SceneData floor_scene(float albedo) {
  SceneData scene;
  scene.path = "floor";
  add_grey(scene, albedo);
  add_quad(scene, {-10, 0, -10}, {0, 0, 20}, {20, 0, 0}, 0);
  return scene;
}

/// Down on the middle of the floor from 2 m above it.
inline const ClpvView kDown = view_of({0, 2, 0}, {0, -1, 0}, {0, 0, -1}, 0.5f, 9, 7);

}  // namespace clpv::test
