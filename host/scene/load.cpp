// SPDX-License-Identifier: MIT
// From a path to a scene: which loader, and what the scene file replaces.
#include "scene/load.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "scene/defaults.hpp"
#include "scene/gltf.hpp"
#include "scene/input.hpp"
#include "scene/notes.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

void find_bounds(Scene& scene) {
  if (scene.vertices.empty()) return;
  scene.lower = glm::vec3(std::numeric_limits<float>::max());
  scene.upper = -scene.lower;
  for (const Vertex& vertex : scene.vertices) {
    const glm::vec3 p(vertex.position[0], vertex.position[1], vertex.position[2]);
    scene.lower = glm::min(scene.lower, p);
    scene.upper = glm::max(scene.upper, p);
  }
}

void check_camera_lights(const Scene& scene) {
  std::vector<std::string> names;
  for (const Light& light : scene.lights) names.push_back("'" + light.name + "'");
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    if (!scene.cameras[i].light.empty() && scene.lights_for(scene.cameras[i]).empty()) {
      refuse(scene.path, fmt::format("/cameras/{}/light", i), "'" + scene.cameras[i].light + "'",
             names.empty() ? "none, since there are no lights" : fmt::format("{}", fmt::join(names, ", ")));
    }
  }
}

std::vector<Part> parts_of(const std::vector<Instance>& meshes) {
  std::vector<Part> parts;
  for (const Instance& instance : meshes) {
    parts.push_back({instance.first_vertex, static_cast<std::uint32_t>(instance.primitive->vertices.size()),
                     instance.first_triangle,
                     static_cast<std::uint32_t>(instance.primitive->triangles.size())});
  }
  return parts;
}

}  // namespace

void MovingScene::load_described(const std::filesystem::path& path, const LoadOptions& options,
                                 Notes& notes) {
  description_ = read_scene_file(path);
  DescribedViews views = views_at(description_, 0);
  const std::filesystem::path model = options.model.empty() ? description_.model : options.model;
  if (model.empty()) refuse(path.string(), "/model", "nothing", "a path to a .gltf or .glb, or option model");
  std::error_code unknown;
  if (options.model.empty() && !std::filesystem::exists(model, unknown)) {
    refuse(path.string(), "/model", "no file '" + model.string() + "'",
           "an existing file; option model says where it lies");
  }
  scene_ = load_gltf(model, description_.metres_per_unit, motion_, notes);
  if (views.cameras) motion_.cameras.clear();
  if (views.lights) motion_.lights.clear();
  show(std::move(views));
  scene_.exposure = description_.exposure;
  scene_.cascade_size = description_.cascade_size;
  scene_.cascades = description_.cascades;
  scene_.sky = description_.sky;
}

void MovingScene::show(DescribedViews views) {
  if (views.cameras) scene_.cameras = std::move(*views.cameras);
  if (views.lights) scene_.lights = std::move(*views.lights);
}

MovingScene::MovingScene(const std::filesystem::path& path, const LoadOptions& options) {
  Notes notes;
  const std::string extension = extension_of(path);
  if (extension == ".json") {
    load_described(path, options, notes);
    scene_.path = path.string();
  } else if (extension == ".gltf" || extension == ".glb") {
    const std::filesystem::path model = options.model.empty() ? path : options.model;
    scene_ = load_gltf(model, 1.0, motion_, notes);
    scene_.path = model.string();
  } else {
    refuse(path.string(), {}, "the extension '" + extension + "'", ".json (a scene file), .gltf or .glb");
  }
  if (motion_.empty()) motion_.tree = {};  // of no use any more
  scene_.moving = parts_of(motion_.meshes);
  find_bounds(scene_);
  add_defaults(scene_, description_.lights.has_value() || scene_.sky, notes);
  check_camera_lights(scene_);
  if (moves()) scene_.start_reach = scene_.reach();
  scene_.name = path.stem().string();
  scene_.notes = notes.take();
}

void MovingScene::pose(double seconds) {
  motion_.pose(scene_, seconds);
  if (!motion_.meshes.empty()) find_bounds(scene_);
  if (description_.moves()) show(views_at(description_, seconds));
}

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options) {
  return MovingScene(path, options).take();
}

bool is_bare_model(const Scene& scene) {
  const std::string extension = extension_of(scene.path);
  return extension == ".gltf" || extension == ".glb";
}

}  // namespace clpv
