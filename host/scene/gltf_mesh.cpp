// SPDX-License-Identifier: MIT
// Appends the meshes of a glTF document to a scene, one or more instances per node.
#include <algorithm>
#include <map>

#include "scene/bounds.hpp"
#include "scene/gltf_parts.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

/// One place of a mesh: a node of the tree, and the transform of an instance to that node's space.
struct MeshPlace {
  std::size_t node;
  std::optional<glm::dmat4> to_node;
};

/// Weights of morph targets without a curve: those of the node, else of the mesh, else 0.
std::vector<double> stored_weights(const GltfDocument& document, const TreeNode& node,
                                   std::size_t targets) {
  const tinygltf::Node& source = entry(document.model.nodes, node.index);
  const bool in_node = !source.weights.empty();
  const std::vector<double>& weights =
      in_node ? source.weights : entry(document.model.meshes, source.mesh).weights;
  if (weights.empty()) return std::vector<double>(targets, 0.0);
  if (weights.size() != targets) {
    reject(document.file,
           in_node ? fmt::format("/nodes/{}/weights", node.index)
                   : fmt::format("/meshes/{}/weights", source.mesh),
           fmt::format("{} weights", weights.size()),
           fmt::format("one for each of {} morph targets", targets));
  }
  return weights;
}

class Appender {
 public:
  Appender(const GltfDocument& document, SceneData& scene, Motion& motion, Notes& notes)
      : document_(document),
        scene_(scene),
        motion_(motion),
        notes_(notes),
        skins_(document, motion.tree) {}

  /// Appends an instance of the primitive at each place. Checks the bounds before it allocates.
  void append(const std::shared_ptr<const LocalPrimitive>& primitive,
              const std::vector<MeshPlace>& places, PosedTree& posed) {
    reserve(scene_, *primitive, places.size(), document_.file);
    for (const MeshPlace& place : places) {
      Instance made = instance(primitive, place.node);
      made.to_node = place.to_node;
      clpv::append(made, posed, scene_);
      if (moves(made, motion_.tree)) motion_.meshes.push_back(std::move(made));
    }
  }

 private:
  Instance instance(const std::shared_ptr<const LocalPrimitive>& primitive, std::size_t node) {
    Instance made;
    made.primitive = primitive;
    made.node = node;
    const TreeNode& at = motion_.tree.nodes[node];
    if (!primitive->targets.empty())
      made.weights = stored_weights(document_, at, primitive->targets.size());
    if (const int skin = entry(document_.model.nodes, at.index).skin; skin >= 0) {
      made.skin = skins_.read(skin);
      if (primitive->influences.empty())
        notes_.add(
            fmt::format("{}: has no joints for the skin of /nodes/{}", primitive->place, at.index));
      check_joints(*primitive, made.skin->joints.size(), skin);
    }
    return made;
  }

  void check_joints(const LocalPrimitive& primitive, std::size_t joints, int skin) const {
    for (std::size_t i = 0; i < primitive.influences.size(); ++i) {
      for (const std::uint16_t joint : primitive.influences[i].joints) {
        if (joint < joints) continue;
        reject(document_.file, primitive.place + "/attributes/JOINTS_0",
               fmt::format("joint {} of vertex {}", joint, primitive.vertices[i].source),
               fmt::format("0 to {}, the joints of /skins/{}", joints - 1, skin));
      }
    }
  }

  const GltfDocument& document_;
  SceneData& scene_;
  Motion& motion_;
  Notes& notes_;
  SkinReader skins_;
};

/// Rejects a primitive whose number of morph targets differs from that of the mesh's first.
void check_targets(const GltfDocument& document, int mesh, std::size_t index) {
  const auto& primitives = entry(document.model.meshes, mesh).primitives;
  if (primitives[index].targets.size() != primitives[0].targets.size()) {
    reject(
        document.file, fmt::format("/meshes/{}/primitives/{}/targets", mesh, index),
        fmt::format("{} morph targets", primitives[index].targets.size()),
        fmt::format("as many as the mesh's first primitive has, {}", primitives[0].targets.size()));
  }
}

}  // namespace

void append_meshes(const GltfDocument& document, PosedTree& posed, const MaterialSet& materials,
                   SceneData& scene, Motion& motion, Notes& notes) {
  const std::vector<TreeNode>& nodes = motion.tree.nodes;
  std::map<int, std::vector<MeshPlace>> places;  // by mesh: each primitive is read once
  std::size_t instances = bounds::kInstances;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const int mesh = entry(document.model.nodes, nodes[i].index).mesh;
    if (mesh < 0) continue;
    for (const auto& to_node : read_instances(document, nodes[i].index, instances, notes))
      places[mesh].push_back({i, to_node});
  }
  Appender appender(document, scene, motion, notes);
  std::vector<std::uint32_t> slots;
  GeometryBudget budget{bounds::kVertices, bounds::kTriangles, bounds::kMorphNumbers};
  for (const auto& [mesh, at] : places) {
    for (std::size_t i = 0; i < entry(document.model.meshes, mesh).primitives.size(); ++i) {
      check_targets(document, mesh, i);
      budget.vertices = bounds::kVertices - scene.vertices.size();
      budget.triangles = bounds::kTriangles - scene.triangles.size();
      LocalPrimitive primitive = read_primitive(document, mesh, i, materials, budget, slots, notes);
      if (primitive.triangles.empty()) continue;
      appender.append(std::make_shared<const LocalPrimitive>(std::move(primitive)), at, posed);
    }
  }
}

}  // namespace clpv
