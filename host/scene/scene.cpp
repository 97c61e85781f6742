// SPDX-License-Identifier: MIT
#include "scene/scene.hpp"

#include <fmt/ranges.h>

#include "support/error.hpp"

namespace clpv {

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

}  // namespace clpv
