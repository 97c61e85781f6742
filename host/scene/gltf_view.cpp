// SPDX-License-Identifier: MIT
// Reads the cameras and lights of a glTF document.
#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "scene/bounds.hpp"
#include "scene/gltf_parts.hpp"
#include "scene/light_kind.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

class ViewReader {
 public:
  ViewReader(const GltfDocument& document, double metres_per_unit, SceneData& scene,
             const ViewNotes& notes)
      : document_(document), metres_per_unit_(metres_per_unit), scene_(scene), notes_(notes) {
    const tinygltf::Model& model = document.model;
    for (const auto& camera : model.cameras) cameras_.reserve(camera.name);
    for (const auto& light : model.lights) lights_.reserve(light.name);
    for (const auto& node : model.nodes) cameras_.reserve(node.name), lights_.reserve(node.name);
  }

  /// Appends the camera of a node. Returns false for an orthographic one.
  bool camera(int node, const tinygltf::Node& source, const glm::dmat4& to_world) {
    const tinygltf::Camera& given = entry(document_.model.cameras, source.camera);
    const std::string place = fmt::format("/cameras/{}", source.camera);
    if (given.type != "perspective") {
      notes_.cameras.add(fmt::format("{} ('{}') is orthographic: not read", place, given.name));
      return false;
    }
    if (scene_.cameras.size() == bounds::kCameras) {
      reject(document_.file, place_of(node), "one more camera",
             fmt::format("at most {}", bounds::kCameras));
    }
    SceneCamera made;
    made.name = cameras_.unique(given.name.empty() ? source.name : given.name, "camera");
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
    made.name = lights_.unique(given.name.empty() ? source.name : given.name, "light");
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
      cone(data, given.spot, fmt::format("/extensions/KHR_lights_punctual/lights/{}/spot", index));
    }
    scene_.lights.push_back(made);
  }

  /// Adds notes on cameras and lights that share names.
  void finish() {
    cameras_.add_notes("camera", notes_.cameras);
    lights_.add_notes("light", notes_.lights);
  }

 private:
  /// Names in use, and those given to others of the same name.
  class Names {
   public:
    /// Keeps a name of the file from being made up for another.
    void reserve(const std::string& name) { reserved_.insert(name); }

    /// Returns `preferred`, or a name like it that is not in use, and uses it.
    std::string unique(const std::string& preferred, const char* kind) {
      std::string name = preferred.empty() ? fmt::format("{} {}", kind, used_.size()) : preferred;
      const auto taken = [&] {
        return used_.contains(name) || (name != preferred && reserved_.contains(name));
      };
      for (int i = 2; taken(); ++i)
        name = fmt::format("{} {}", preferred.empty() ? kind : preferred, i);
      used_.insert(name);
      if (!preferred.empty() && name != preferred) renamed_[preferred].push_back(name);
      return name;
    }

    void add_notes(const char* kind, Notes& notes) const {
      for (const auto& [name, others] : renamed_) {
        notes.add(fmt::format("{} {}s have the name '{}': the {} called '{}'{}", others.size() + 1,
                              kind, name, others.size() == 1 ? "second is" : "others are",
                              others.front(), others.size() == 1 ? "" : " and so on"));
      }
    }

   private:
    std::set<std::string> used_, reserved_;
    std::map<std::string, std::vector<std::string>> renamed_;
  };

  void cone(ClpvLight& light, const tinygltf::SpotLight& given, const std::string& place) {
    const double right_angle = std::numbers::pi / 2;  // the schema admits it rounded up
    const double inner = std::min(given.innerConeAngle, right_angle),
                 outer = std::min(given.outerConeAngle, right_angle);
    if (inner > outer) {
      reject(document_.file, place,
             fmt::format("innerConeAngle {} and outerConeAngle {}", inner, outer),
             "inner less than outer, or equal: a hard edge");
    }
    if (inner == outer)
      notes_.lights.add(fmt::format(
          "{}: innerConeAngle and outerConeAngle are both {}: a hard edge", place, inner));
    set_cone(light, inner, outer);
  }

  static std::string place_of(int node) { return fmt::format("/nodes/{}", node); }

  const GltfDocument& document_;
  double metres_per_unit_;
  SceneData& scene_;
  ViewNotes notes_;
  Names cameras_, lights_;
};

}  // namespace

void append_views(const GltfDocument& document, const PosedTree& posed, double metres_per_unit,
                  SceneData& scene, Motion& motion, const ViewNotes& notes) {
  ViewReader reader(document, metres_per_unit, scene, notes);
  for (std::size_t i = 0; i < motion.tree.nodes.size(); ++i) {
    const TreeNode& node = motion.tree.nodes[i];
    const tinygltf::Node& source = entry(document.model.nodes, node.index);
    if (source.camera >= 0 && reader.camera(node.index, source, posed.unmirrored(i)) &&
        node.moves) {
      motion.cameras.push_back({scene.cameras.size() - 1, i});
    }
    if (const auto found = source.extensions.find("KHR_lights_punctual");
        found != source.extensions.end()) {
      reader.light(node.index, source, found->second.Get("light").GetNumberAsInt(),
                   posed.unmirrored(i));
      if (node.moves) motion.lights.push_back({scene.lights.size() - 1, i});
    }
  }
  reader.finish();
}

}  // namespace clpv
