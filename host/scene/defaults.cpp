// SPDX-License-Identifier: MIT
#include "scene/defaults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clpv {
namespace {

// The sun added to a model without lights: steep, from behind the framing camera's right shoulder. An
// illuminance of 10 shows a white floor at radiance 3.2, so that diffuse walls fill the tone curve's range at
// exposure 0.
constexpr glm::vec3 kSunDirection{-0.35f, -0.85f, -0.4f};
constexpr float kSunIlluminance = 10;

// The camera added to a model without cameras: from above and the side, the box's sphere just within its
// view.
constexpr glm::vec3 kFramingDirection{-0.5f, -0.35f, -1.0f};  // of sight
constexpr float kFramingFov = static_cast<float>(std::numbers::pi) / 4;

Camera framing_camera(const Scene& scene) {
  Camera camera;
  camera.name = "framing";
  camera.forward = glm::normalize(kFramingDirection);
  const glm::vec3 up(0, 1, 0);
  camera.up = glm::normalize(up - camera.forward * glm::dot(camera.forward, up));
  camera.vertical_fov = kFramingFov;
  const float radius = std::max(glm::length(scene.upper - scene.lower) / 2, 1e-3f);
  const float distance = radius / std::sin(kFramingFov / 2);
  camera.eye = (scene.lower + scene.upper) / 2.0f - camera.forward * distance;
  camera.near_depth = (distance - radius) / 2;
  return camera;
}

Light added_sun() {
  Light sun;
  sun.name = "sun";
  sun.data.kind = CLPV_LIGHT_DIRECTIONAL;
  const glm::vec3 direction = glm::normalize(kSunDirection);
  for (int i = 0; i < 3; ++i) {
    sun.data.direction[i] = direction[i];
    sun.data.intensity[i] = kSunIlluminance;
  }
  return sun;
}

}  // namespace

void add_defaults(Scene& scene, bool lights_given, Notes& notes) {
  if (scene.triangles.empty()) notes.add("the model has no triangles");
  if (scene.cameras.empty()) {
    scene.cameras.push_back(framing_camera(scene));
    notes.add("no camera: added one that frames the model");
  }
  if (scene.lights.empty() && !lights_given) {
    scene.lights.push_back(added_sun());
    notes.add(fmt::format("no light: added a sun of {} lux", kSunIlluminance));
  }
}

}  // namespace clpv
