// SPDX-License-Identifier: MIT
#include "scene/gltf_view.hpp"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <set>

#include "scene/bounds.hpp"
#include "scene/light_cone.hpp"
#include "scene/light_kind.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

class ViewReader {
 public:
  ViewReader(const GltfDocument& document, double metres_per_unit, Scene& scene, Notes& notes)
      : document_(document), metres_per_unit_(metres_per_unit), scene_(scene), notes_(notes) {}

  void camera(const GltfNode& node, const tinygltf::Node& source) {
    const tinygltf::Camera& given = document_.model.cameras[static_cast<std::size_t>(source.camera)];
    const std::string place = fmt::format("/cameras/{}", source.camera);
    if (given.type != "perspective") {
      notes_.add(fmt::format("{} ('{}') is orthographic and left out", place, given.name));
      return;
    }
    if (scene_.cameras.size() == bounds::kCameras) {
      refuse(document_.file, place_of(node), "one more camera", fmt::format("at most {}", bounds::kCameras));
    }
    Camera made;
    made.name = unique(given.name.empty() ? source.name : given.name, "camera", camera_names_);
    made.eye = position(node);
    made.forward = axis(node, {0, 0, -1}, "/camera");
    const glm::dvec3 up(axis(node, {0, 1, 0}, "/camera")), forward(made.forward);
    const glm::dvec3 across = up - forward * glm::dot(forward, up);  // a sheared node tilts it
    if (glm::length(across) < 1e-6)
      refuse(document_.file, place_of(node), "a camera's transform without up", "up across forward");
    made.up = glm::vec3(glm::normalize(across));
    made.vertical_fov = static_cast<float>(given.perspective.yfov);
    made.near_depth = static_cast<float>(given.perspective.znear * metres_per_unit_);
    scene_.cameras.push_back(made);
  }

  void light(const GltfNode& node, const tinygltf::Node& source, int index) {
    const tinygltf::Light& given = document_.model.lights[static_cast<std::size_t>(index)];
    if (scene_.lights.size() == bounds::kLights) {
      refuse(document_.file, place_of(node), "one more light", fmt::format("at most {}", bounds::kLights));
    }
    Light made;
    made.name = unique(given.name.empty() ? source.name : given.name, "light", light_names_);
    ClpvLight& data = made.data;
    const LightKind kind = named<LightKind>("type", given.type);
    data.kind = static_cast<unsigned>(kind);
    store(data.position, position(node));
    if (kind != LightKind::point)
      store(data.direction, axis(node, {0, 0, -1}, "/extensions/KHR_lights_punctual"));
    for (std::size_t i = 0; i < 3; ++i) {
      data.intensity[i] = static_cast<float>(given.intensity * (given.color.empty() ? 1.0 : given.color[i]));
    }
    if (kind != LightKind::directional) data.range = static_cast<float>(given.range * metres_per_unit_);
    if (kind == LightKind::spot) {
      const double inner = given.spot.innerConeAngle, outer = given.spot.outerConeAngle;
      if (inner >= outer) {
        refuse(document_.file, fmt::format("/extensions/KHR_lights_punctual/lights/{}/spot", index),
               fmt::format("innerConeAngle {} and outerConeAngle {}", inner, outer), "inner less than outer");
      }
      set_cone(data, inner, outer);
    }
    scene_.lights.push_back(made);
  }

 private:
  static std::string place_of(const GltfNode& node) { return fmt::format("/nodes/{}", node.index); }
  static void store(float (&to)[3], const glm::vec3& from) { std::copy_n(glm::value_ptr(from), 3, to); }

  glm::vec3 position(const GltfNode& node) const {
    const glm::dvec3 p(node.to_world[3]);
    if (glm::any(glm::greaterThan(glm::abs(p), glm::dvec3(bounds::kCoordinate)))) {
      refuse(document_.file, place_of(node), fmt::format("({}, {}, {}) m", p.x, p.y, p.z),
             fmt::format("coordinates within +-{} m", bounds::kCoordinate));
    }
    return glm::vec3(p);
  }

  glm::vec3 axis(const GltfNode& node, const glm::dvec3& local, const char* what) const {
    const glm::dvec3 direction = glm::dmat3(node.to_world) * local;
    const double length = glm::length(direction);
    if (!(length > 0) || !std::isfinite(length)) {
      refuse(document_.file, place_of(node) + what, "a transform that leaves no direction",
             "scales other than 0");
    }
    return glm::vec3(direction / length);
  }

  static std::string unique(const std::string& wish, const char* kind, std::set<std::string>& taken) {
    std::string name = wish.empty() ? fmt::format("{} {}", kind, taken.size()) : wish;
    for (int i = 2; taken.contains(name); ++i) name = fmt::format("{} {}", wish.empty() ? kind : wish, i);
    taken.insert(name);
    return name;
  }

  const GltfDocument& document_;
  double metres_per_unit_;
  Scene& scene_;
  Notes& notes_;
  std::set<std::string> camera_names_, light_names_;
};

}  // namespace

void append_views(const GltfDocument& document, const std::vector<GltfNode>& nodes, double metres_per_unit,
                  Scene& scene, Notes& notes) {
  ViewReader reader(document, metres_per_unit, scene, notes);
  for (const GltfNode& node : nodes) {
    const tinygltf::Node& source = document.model.nodes[static_cast<std::size_t>(node.index)];
    if (source.camera >= 0) reader.camera(node, source);
    if (const auto found = source.extensions.find("KHR_lights_punctual"); found != source.extensions.end()) {
      reader.light(node, source, found->second.Get("light").GetNumberAsInt());
    }
  }
}

}  // namespace clpv
