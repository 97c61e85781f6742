// SPDX-License-Identifier: MIT
#include "scene/view_placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "scene/bounds.hpp"
#include "scene/light_kind.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

/// A node's transform, and what to call it.
struct NodePlace {
  const glm::dmat4& to_world;
  const std::string& file;
  std::string node;
};

void store(float (&to)[3], const glm::vec3& from) {
  std::copy_n(glm::value_ptr(from), 3, to);
}

glm::vec3 position(const NodePlace& place) {
  const glm::dvec3 p(place.to_world[3]);
  if (glm::any(glm::greaterThan(glm::abs(p), glm::dvec3(bounds::kCoordinate)))) {
    refuse(place.file, place.node, fmt::format("({}, {}, {}) m", p.x, p.y, p.z),
           fmt::format("coordinates within +-{} m", bounds::kCoordinate));
  }
  return glm::vec3(p);
}

glm::vec3 axis(const NodePlace& place, const glm::dvec3& local, const char* what) {
  const glm::dvec3 direction = glm::dmat3(place.to_world) * local;
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length)) {
    refuse(place.file, place.node + what, "a transform that leaves no direction", "scales other than 0");
  }
  return glm::vec3(direction / length);
}

}  // namespace

void place_camera(Camera& camera, const glm::dmat4& to_world, const std::string& file, int node) {
  const NodePlace place{to_world, file, fmt::format("/nodes/{}", node)};
  camera.eye = position(place);
  camera.forward = axis(place, {0, 0, -1}, "/camera");
  const glm::dvec3 up(axis(place, {0, 1, 0}, "/camera")), forward(camera.forward);
  const glm::dvec3 across = up - forward * glm::dot(forward, up);  // a sheared node tilts it
  if (glm::length(across) < 1e-6)
    refuse(file, place.node, "a camera's transform without up", "up across forward");
  camera.up = glm::vec3(glm::normalize(across));
}

void place_light(ClpvLight& light, const glm::dmat4& to_world, const std::string& file, int node) {
  const NodePlace place{to_world, file, fmt::format("/nodes/{}", node)};
  store(light.position, position(place));
  if (kind_of(light) != LightKind::point)
    store(light.direction, axis(place, {0, 0, -1}, "/extensions/KHR_lights_punctual"));
}

}  // namespace clpv
