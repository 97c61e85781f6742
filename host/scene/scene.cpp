// SPDX-License-Identifier: MIT
// Cameras and lights of a scene by name, and hashes of its animated parts.

#include "scene/scene.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "scene/sky.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"

namespace clpv {

ClpvMaterial blank_material() {
  ClpvMaterial made{};
  std::fill(std::begin(made.base_colour), std::end(made.base_colour), 1.0f);
  made.texture = made.emissive_texture = CLPV_NO_TEXTURE;
  return made;
}

Bounds bounds_of(const std::vector<Vertex>& vertices) {
  if (vertices.empty()) return {};
  Bounds box{glm::vec3(std::numeric_limits<float>::max()),
             glm::vec3(std::numeric_limits<float>::lowest())};
  for (const Vertex& vertex : vertices) {
    const glm::vec3 p(vertex.position[0], vertex.position[1], vertex.position[2]);
    box = {glm::min(box.lower, p), glm::max(box.upper, p)};
  }
  return box;
}

double SceneData::reach() const {
  if (start_reach) return *start_reach;
  double reach = 0;
  for (const SceneCamera& camera : cameras) {
    const glm::vec3 distance = glm::max(glm::abs(lower - camera.eye), glm::abs(upper - camera.eye));
    reach = std::max<double>({reach, distance.x, distance.y, distance.z});
  }
  return reach;
}

const SceneCamera& SceneData::camera(const std::string& name) const {
  std::vector<std::string> names;
  for (const SceneCamera& candidate : cameras) {
    if (name.empty() || candidate.name == name) return candidate;
    names.push_back(candidate.name);
  }
  throw Error(ExitCode::usage, "{}: no camera named '{}'; allowed: {}", path, name,
              fmt::join(names, ", "));
}

bool SceneData::has_light(const std::string& name) const {
  return std::ranges::find(lights, name, &SceneLight::name) != lights.end();
}

std::vector<SceneLight> SceneData::lights_for(const SceneCamera& camera) const {
  const bool one = !camera.light.empty() && has_light(camera.light);
  std::vector<SceneLight> shining;
  for (const SceneLight& light : lights) {
    if (one && light.name != camera.light) continue;
    shining.push_back(light);
    for (float& channel : shining.back().data.intensity) channel *= light_scale;
    if (medium) shining.back().data.medium = *medium;
  }
  return shining;
}

std::string scene_fingerprint(const SceneData& scene) {
  Fingerprint print;
  print.add(scene.vertices).add(scene.triangles).add(scene.materials);
  for (const Texture& texture : scene.textures) {
    print.add(texture.width)
        .add(texture.height)
        .add(texture.wrap_u)
        .add(texture.wrap_v)
        .add(texture.rgba);
  }
  if (scene.sky) add_sky(print, *scene.sky);
  if (scene.medium) print.add(*scene.medium);
  return print.hex();
}

void add_range(Fingerprint& print, const SceneData& scene, const MeshRange& range) {
  print.add(std::as_bytes(std::span(scene.vertices).subspan(range.first_vertex, range.vertices)));
  print.add(
      std::as_bytes(std::span(scene.triangles).subspan(range.first_triangle, range.triangles)));
}

void add_moving(Fingerprint& print, const SceneData& scene) {
  for (const MeshRange& range : scene.moving) add_range(print, scene, range);
}

MediumPart medium_part(const ClpvMedium& medium, const glm::dvec3& origin,
                       const glm::dvec3& direction, double end) {
  if (vector(medium.extinction) == glm::dvec3(0)) return {};
  MediumPart part{0, end};
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = double{medium.lower[axis]} - origin[axis],
                 upper = double{medium.upper[axis]} - origin[axis];
    if (direction[axis] == 0) {
      if (lower > 0 || upper < 0) return {};
      continue;
    }
    const double a = lower / direction[axis], b = upper / direction[axis];
    part.start = std::max(part.start, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  return part;
}

glm::dvec3 transmittance(const ClpvMedium& medium, const MediumPart& part) {
  return glm::exp(-part.length() * vector(medium.extinction));
}

}  // namespace clpv
