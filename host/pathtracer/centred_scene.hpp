// SPDX-License-Identifier: MIT
// A scene moved to the coordinates' origin, where floats resolve small distances wherever the scene
// lies.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace clpv::pathtracer {

inline void move(float position[3], const glm::dvec3& by) {
  for (int axis = 0; axis < 3; ++axis) position[axis] = double{position[axis]} + by[axis];
}

inline void move(ClpvMedium& medium, const glm::dvec3& by) {
  move(medium.lower, by), move(medium.upper, by);
}

/// A scene and its lights, moved.
struct CentredScene {
  SceneData scene;
  std::vector<SceneLight> lights;

  CentredScene(const SceneData& at, const std::vector<SceneLight>& lit_by, const glm::dvec3& by)
      : scene(at), lights(lit_by) {
    for (Vertex& v : scene.vertices) move(v.position, by);
    for (SceneLight& light : lights) move(light.data.position, by), move(light.data.medium, by);
    if (scene.medium) move(*scene.medium, by);
  }
};

}  // namespace clpv::pathtracer
