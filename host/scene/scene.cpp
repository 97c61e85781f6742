// SPDX-License-Identifier: MIT
#include "scene/scene.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "support/error.hpp"
#include "support/fingerprint.hpp"

namespace clpv {

double Scene::reach() const {
  if (start_reach) return *start_reach;
  double reach = 0;
  for (const Camera& camera : cameras) {
    const glm::vec3 away = glm::max(glm::abs(lower - camera.eye), glm::abs(upper - camera.eye));
    reach = std::max<double>({reach, away.x, away.y, away.z});
  }
  return reach;
}

const Camera& Scene::camera(const std::string& name) const {
  std::vector<std::string> names;
  for (const Camera& candidate : cameras) {
    if (name.empty() || candidate.name == name) return candidate;
    names.push_back(candidate.name);
  }
  throw Error(ExitCode::usage, "{}: no camera named '{}'; there are: {}", path, name, fmt::join(names, ", "));
}

std::vector<Light> Scene::lights_for(const Camera& camera) const {
  if (camera.light.empty()) return lights;
  std::vector<Light> chosen;
  for (const Light& light : lights) {
    if (light.name == camera.light) chosen.push_back(light);
  }
  return chosen;
}

void add_part(Fingerprint& print, const Scene& scene, const Part& part) {
  print.add(std::as_bytes(std::span(scene.vertices).subspan(part.first_vertex, part.vertices)));
  print.add(std::as_bytes(std::span(scene.triangles).subspan(part.first_triangle, part.triangles)));
}

void add_moving(Fingerprint& print, const Scene& scene) {
  for (const Part& part : scene.moving) add_part(print, scene, part);
}

}  // namespace clpv
