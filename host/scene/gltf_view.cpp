// SPDX-License-Identifier: MIT
// Reads the cameras and lights of a glTF document.
#include <set>

#include "scene/bounds.hpp"
#include "scene/gltf_parts.hpp"
#include "scene/light_kind.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

class ViewReader {
 public:
  ViewReader(const GltfDocument& document, double metres_per_unit, SceneData& scene, Notes& notes)
      : document_(document), metres_per_unit_(metres_per_unit), scene_(scene), notes_(notes) {}

  /// Appends the camera of a node. Returns false for an orthographic one.
  bool camera(int node, const tinygltf::Node& source, const glm::dmat4& to_world) {
    const tinygltf::Camera& given = entry(document_.model.cameras, source.camera);
    const std::string place = fmt::format("/cameras/{}", source.camera);
    if (given.type != "perspective") {
      notes_.add(fmt::format("{} ('{}') is orthographic: not read", place, given.name));
      return false;
    }
    if (scene_.cameras.size() == bounds::kCameras) {
      reject(document_.file, place_of(node), "one more camera",
             fmt::format("at most {}", bounds::kCameras));
    }
    SceneCamera made;
    made.name = unique(given.name.empty() ? source.name : given.name, "camera", camera_names_);
    place_camera(made, to_world, document_.file, node);
    made.vertical_fov = static_cast<float>(given.perspective.yfov);
    made.near_depth = static_cast<float>(given.perspective.znear * metres_per_unit_);
    scene_.cameras.push_back(made);
    return true;
  }

  void light(int node, const tinygltf::Node& source, int index, const glm::dmat4& to_world) {
    const tinygltf::Light& given = entry(document_.model.lights, index);
    if (scene_.lights.size() == bounds::kLights) {
      reject(document_.file, place_of(node), "one more light",
             fmt::format("at most {}", bounds::kLights));
    }
    SceneLight made;
    made.name = unique(given.name.empty() ? source.name : given.name, "light", light_names_);
    ClpvLight& data = made.data;
    const LightKind kind = named<LightKind>("type", given.type);
    data.kind = static_cast<unsigned>(kind);
    place_light(data, to_world, document_.file, node);
    for (std::size_t i = 0; i < 3; ++i) {
      data.intensity[i] =
          static_cast<float>(given.intensity * (given.color.empty() ? 1.0 : given.color[i]));
    }
    if (kind != LightKind::directional)
      data.range = static_cast<float>(given.range * metres_per_unit_);
    if (kind == LightKind::spot) {
      const double inner = given.spot.innerConeAngle, outer = given.spot.outerConeAngle;
      if (inner >= outer) {
        reject(document_.file, fmt::format("/extensions/KHR_lights_punctual/lights/{}/spot", index),
               fmt::format("innerConeAngle {} and outerConeAngle {}", inner, outer),
               "inner less than outer");
      }
      set_cone(data, inner, outer);
    }
    scene_.lights.push_back(made);
  }

 private:
  static std::string place_of(int node) { return fmt::format("/nodes/{}", node); }

  /// Returns `preferred`, or a name like it that is not in `used`, and adds it there.
  static std::string unique(const std::string& preferred, const char* kind,
                            std::set<std::string>& used) {
    std::string name = preferred.empty() ? fmt::format("{} {}", kind, used.size()) : preferred;
    for (int i = 2; used.contains(name); ++i)
      name = fmt::format("{} {}", preferred.empty() ? kind : preferred, i);
    used.insert(name);
    return name;
  }

  const GltfDocument& document_;
  double metres_per_unit_;
  SceneData& scene_;
  Notes& notes_;
  std::set<std::string> camera_names_, light_names_;
};

}  // namespace

void append_views(const GltfDocument& document, const PosedTree& posed, double metres_per_unit,
                  SceneData& scene, Motion& motion, Notes& notes) {
  ViewReader reader(document, metres_per_unit, scene, notes);
  for (std::size_t i = 0; i < motion.tree.nodes.size(); ++i) {
    const TreeNode& node = motion.tree.nodes[i];
    const tinygltf::Node& source = entry(document.model.nodes, node.index);
    if (source.camera >= 0 && reader.camera(node.index, source, posed.to_world(i)) && node.moves) {
      motion.cameras.push_back({scene.cameras.size() - 1, i});
    }
    if (const auto found = source.extensions.find("KHR_lights_punctual");
        found != source.extensions.end()) {
      reader.light(node.index, source, found->second.Get("light").GetNumberAsInt(),
                   posed.to_world(i));
      if (node.moves) motion.lights.push_back({scene.lights.size() - 1, i});
    }
  }
}

}  // namespace clpv
