// SPDX-License-Identifier: MIT
// Appends the meshes of a glTF document to a scene, one or more instances per node.

#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/gltf_parts.hpp"
#include "support/error.hpp"

namespace clpv {

// Reads the attributes, triangles, joints and morph targets of a mesh primitive.

namespace {

constexpr double kMaxWeight = 1e6;  // a joint's, before weights are normalised to a sum of 1

/// Accessors of a primitive's attributes, with equal counts.
struct Attributes {
  GltfAccessor position;
  std::optional<GltfAccessor> normal, uv, colour, indices;
};

TriangleOrder order_of(int mode) {
  switch (mode) {
    case TINYGLTF_MODE_TRIANGLE_STRIP:
      return TriangleOrder::strip;
    case TINYGLTF_MODE_TRIANGLE_FAN:
      return TriangleOrder::fan;
    default:
      return TriangleOrder::list;
  }
}

class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, const tinygltf::Primitive& source,
                  std::string place, const UvMapping& mapping)
      : document_(document), source_(source), place_(std::move(place)), mapping_(mapping) {}

  Attributes attributes(bool textured, Notes& notes) const {
    const auto find = [&](const std::string& name, Types types, std::optional<std::size_t> count,
                          const ComponentTypes& numbers = kNumbers) {
      return attribute(source_.attributes, "/attributes", name, types, count, numbers);
    };
    const auto position = find("POSITION", {TINYGLTF_TYPE_VEC3}, std::nullopt);
    if (!position) reject_here("no attribute POSITION", "POSITION, a VEC3");
    const std::size_t count = position->count();
    Attributes made{*position, find("NORMAL", {TINYGLTF_TYPE_VEC3}, count), std::nullopt,
                    find("COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, count, kFractions),
                    std::nullopt};
    if (source_.indices >= 0) {
      made.indices = GltfAccessor(document_, source_.indices, place_ + "/indices",
                                  {TINYGLTF_TYPE_SCALAR}, kIndices);
    }
    if (textured) {
      const std::string set = fmt::format("TEXCOORD_{}", mapping_.set);
      made.uv = find(set, {TINYGLTF_TYPE_VEC2}, count);
      if (!made.uv) notes.add(fmt::format("{}: no {} for its material: uses 0, 0", place_, set));
    }
    return made;
  }

  /// Reads joints and normalised weights of the vertices.
  void read_influences(const Attributes& from, LocalPrimitive& to) const {
    const auto find = [&](const char* name, const ComponentTypes& numbers) {
      return attribute(source_.attributes, "/attributes", name, {TINYGLTF_TYPE_VEC4},
                       from.position.count(), numbers);
    };
    const auto joints = find("JOINTS_0", kJoints), weights = find("WEIGHTS_0", kFractions);
    if (joints.has_value() != weights.has_value()) {
      reject(document_.file, place_ + "/attributes",
             joints ? "JOINTS_0 without WEIGHTS_0" : "WEIGHTS_0 without JOINTS_0", "both or none");
    }
    if (!joints) return;
    to.influences.reserve(to.vertices.size());
    for (const LocalVertex& vertex : to.vertices) {
      Influence made{};
      double sum = 0;
      for (int i = 0; i < 4; ++i) {
        const double weight = weights->number(vertex.source, i);
        if (!(weight >= 0 && weight <= kMaxWeight)) {
          reject(document_.file, place_ + "/attributes/WEIGHTS_0",
                 fmt::format("{} in component {} of vertex {}", weight, i, vertex.source),
                 fmt::format("0 to {}", kMaxWeight));
        }
        made.joints[i] = static_cast<std::uint16_t>(joints->index(vertex.source, i));
        made.weights[i] = weight;
        sum += weight;
      }
      for (double& weight : made.weights) weight = sum > 0 ? weight / sum : 0;
      if (sum == 0) made.weights[0] = 1;
      to.influences.push_back(made);
    }
  }

  /// Morphs positions and normals; notes other attributes of the targets, such as COLOR_0. Nothing
  /// here uses tangents.
  void read_targets(const Attributes& from, GeometryBudget& budget, LocalPrimitive& to,
                    Notes& notes) const {
    std::set<std::string> others;
    for (std::size_t t = 0; t < source_.targets.size(); ++t) {
      for (const auto& [name, accessor] : source_.targets[t]) {
        if (name != "POSITION" && name != "NORMAL" && name != "TANGENT") others.insert(name);
      }
      const std::string place = fmt::format("/targets/{}", t);
      const auto read = [&](const char* name) {
        std::vector<glm::vec3> made;
        const auto found =
            attribute(source_.targets[t], place, name, {TINYGLTF_TYPE_VEC3}, from.position.count());
        if (!found) return made;
        const std::uint64_t numbers = 3 * to.vertices.size();
        if (numbers > budget.morph_numbers) {
          reject(document_.file, place_ + place,
                 fmt::format("{} more numbers of morph targets", numbers),
                 fmt::format("{} left of {} in all", budget.morph_numbers, bounds::kMorphNumbers));
        }
        budget.morph_numbers -= numbers;
        made.reserve(to.vertices.size());
        for (const LocalVertex& vertex : to.vertices)
          made.emplace_back(vector_in(*found, vertex.source));
        return made;
      };
      MorphTarget target{read("POSITION"), {}};
      if (to.normals == Normals::stored) target.normals = read("NORMAL");
      to.targets.push_back(std::move(target));
    }
    if (!others.empty())
      notes.add(fmt::format("{}/targets: not morphed: {}", place_, fmt::join(others, ", ")));
  }

 private:
  using Types = std::initializer_list<int>;

  std::optional<GltfAccessor> attribute(const std::map<std::string, int>& attributes,
                                        const std::string& place, const std::string& name,
                                        Types types, std::optional<std::size_t> count,
                                        const ComponentTypes& numbers = kNumbers) const {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return std::nullopt;
    return GltfAccessor(document_, found->second, fmt::format("{}{}/{}", place_, place, name),
                        types, numbers, count);
  }

  [[noreturn]] void reject_here(const std::string& found, const std::string& allowed) const {
    reject(document_.file, place_, found, allowed);
  }

  const GltfDocument& document_;
  const tinygltf::Primitive& source_;
  std::string place_;
  const UvMapping& mapping_;
};

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

LocalPrimitive read_primitive(const GltfDocument& document, int mesh, std::size_t index,
                              const MaterialSet& materials, GeometryBudget& budget,
                              std::vector<std::uint32_t>& slots, Notes& notes) {
  const tinygltf::Primitive& source = entry(document.model.meshes, mesh).primitives[index];
  const std::string place = fmt::format("/meshes/{}/primitives/{}", mesh, index);
  if (source.mode < TINYGLTF_MODE_TRIANGLES) {
    notes.add(fmt::format("{}: made of {}, which are not drawn", place,
                          source.mode == TINYGLTF_MODE_POINTS ? "points" : "lines"));
    return {};
  }
  const auto number = static_cast<std::uint32_t>(
      source.material < 0 ? static_cast<int>(materials.materials.size()) - 1 : source.material);
  const ClpvMaterial& material = materials.materials[number];
  const bool textured =
      material.texture != CLPV_NO_TEXTURE || material.emissive_texture != CLPV_NO_TEXTURE;
  const UvMapping& mapping = materials.mappings[number];
  const PrimitiveReader reader(document, source, place, mapping);
  const Attributes attributes = reader.attributes(textured, notes);
  const auto pointer = [](const auto& accessor) { return accessor ? &*accessor : nullptr; };
  LocalPrimitive made =
      make_primitive({&attributes.position, pointer(attributes.normal), pointer(attributes.uv),
                      pointer(attributes.colour), pointer(attributes.indices),
                      order_of(source.mode), mapping.transform},
                     document.file, place, number, budget, slots);
  reader.read_influences(attributes, made);
  reader.read_targets(attributes, budget, made, notes);
  if (source.attributes.contains("JOINTS_1"))
    notes.add(fmt::format("{}: more than four joints per vertex: only JOINTS_0 is read", place));
  return made;
}

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
