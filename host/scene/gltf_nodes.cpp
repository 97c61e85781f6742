// SPDX-License-Identifier: MIT
// Reads the node tree and the skins of a glTF document.

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <set>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/gltf_parts.hpp"
#include "support/error.hpp"

namespace clpv {

// Reads the instances of EXT_mesh_gpu_instancing: one mesh many times at one node.

namespace {

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

/// One attribute of the instances of a node.
struct Attribute {
  const char* name;
  int type;
  const ComponentTypes& numbers;
};

constexpr Attribute kTranslation{"TRANSLATION", TINYGLTF_TYPE_VEC3, kFloats},
    kRotation{"ROTATION", TINYGLTF_TYPE_VEC4, kFractions},
    kScale{"SCALE", TINYGLTF_TYPE_VEC3, kFloats};

/// Attributes of a node's instances, which have one element each.
class InstanceReader {
 public:
  InstanceReader(const GltfDocument& document, int node, const tinygltf::Value& attributes)
      : document_(document),
        place_(fmt::format("/nodes/{}/extensions/{}/attributes", node, kExtension)),
        translations_(find(attributes, kTranslation)),
        rotations_(find(attributes, kRotation)),
        scales_(find(attributes, kScale)) {
    if (!count_) reject(document.file, place_, "no attribute", "TRANSLATION, ROTATION or SCALE");
  }

  std::size_t count() const { return *count_; }
  const std::string& place() const { return place_; }

  glm::dmat4 matrix(std::size_t instance) const {
    Pose pose;
    if (translations_) pose.translation = vector_in(*translations_, instance);
    if (scales_) pose.scale = vector_in(*scales_, instance);
    if (!rotations_) return pose.matrix();
    const auto part = [&](int component) { return rotations_->finite(instance, component); };
    const glm::dquat rotation(part(3), part(0), part(1), part(2));  // stored as x, y, z, w
    if (!(glm::length(rotation) > 0.5)) {
      rotations_->reject_element(instance,
                                 fmt::format("a quaternion of length {}", glm::length(rotation)),
                                 "unit quaternions");
    }
    pose.rotation = glm::normalize(rotation);
    return pose.matrix();
  }

 private:
  std::optional<GltfAccessor> find(const tinygltf::Value& attributes, const Attribute& wanted) {
    if (!attributes.Has(wanted.name)) return std::nullopt;
    GltfAccessor found(document_, attributes.Get(wanted.name).GetNumberAsInt(),
                       place_ + "/" + wanted.name, {wanted.type}, wanted.numbers, count_);
    count_ = found.count();
    return found;
  }

  const GltfDocument& document_;
  std::string place_;
  std::optional<std::size_t> count_;  ///< elements of the attributes so far
  std::optional<GltfAccessor> translations_, rotations_, scales_;
};

/// Names of attributes that are not read, such as colours.
std::vector<std::string> others_in(const tinygltf::Value& attributes) {
  std::vector<std::string> names =
      attributes.IsObject() ? attributes.Keys() : std::vector<std::string>();
  std::erase_if(names, [](const std::string& name) {
    return name == kTranslation.name || name == kRotation.name || name == kScale.name;
  });
  return names;
}

constexpr int kNone = -1;

std::string place_of(int node) {
  return fmt::format("/nodes/{}", node);
}

/// Parent of each node. Rejects several parents, so that the nodes below a root form a tree.
std::vector<int> find_parents(const GltfDocument& document) {
  std::vector<int> parents(document.model.nodes.size(), kNone);
  for (std::size_t i = 0; i < parents.size(); ++i) {
    for (const int child : document.model.nodes[i].children) {
      int& parent = parents[child];
      if (parent != kNone) {
        reject(document.file, place_of(child), fmt::format("parents {} and {}", parent, i),
               "one parent at most");
      }
      parent = static_cast<int>(i);
    }
  }
  return parents;
}

Pose stored_pose(const tinygltf::Node& node, const std::string& file, int index) {
  Pose pose;
  if (!node.translation.empty()) pose.translation = glm::make_vec3(node.translation.data());
  if (!node.scale.empty()) pose.scale = glm::make_vec3(node.scale.data());
  if (!node.rotation.empty()) {  // glTF: x, y, z, w
    const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1],
                              node.rotation[2]);
    if (glm::length(rotation) < 0.5) {
      reject(file, place_of(index) + "/rotation",
             fmt::format("a quaternion of length {}", glm::length(rotation)), "a unit quaternion");
    }
    pose.rotation = glm::normalize(rotation);
  }
  return pose;
}

/// Throws Error(bad_input) for a matrix that is not affine (glTF 2.0, 3.5.3).
void check_matrix(const tinygltf::Node& node, const std::string& file, int index) {
  const std::vector<double>& m = node.matrix;  // by columns
  if (m.empty()) return;
  constexpr double kRounding = 1e-6;  // rounding by exporters
  if (std::max({std::abs(m[3]), std::abs(m[7]), std::abs(m[11]), std::abs(m[15] - 1)}) > kRounding)
    reject(file, place_of(index) + "/matrix",
           fmt::format("last row {}, {}, {}, {}", m[3], m[7], m[11], m[15]), "0, 0, 0, 1");
}

TreeNode make_node(const GltfDocument& document, int index,
                   const std::map<int, NodeCurves>& curves) {
  const tinygltf::Node& source = entry(document.model.nodes, index);
  TreeNode made;
  made.index = index;
  check_matrix(source, document.file, index);
  made.pose = stored_pose(source, document.file, index);
  made.rest = source.matrix.empty() ? made.pose.matrix() : glm::make_mat4(source.matrix.data());
  if (const auto found = curves.find(index); found != curves.end()) made.curves = found->second;
  made.moves = made.curves.moves();
  return made;
}

std::vector<int> root_nodes(const GltfDocument& document, const std::vector<int>& parents,
                            Notes& notes) {
  std::vector<int> roots;
  const std::size_t scenes = document.model.scenes.size();
  if (scenes > 1 && document.model.defaultScene < 0)
    notes.add(fmt::format("/scene: none of {} scenes: /scenes/0 is shown", scenes));
  if (scenes == 0) {
    for (std::size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] == kNone) roots.push_back(static_cast<int>(i));
    }
    if (roots.empty() && !parents.empty()) reject(document.file, "/nodes", "a cycle", "trees");
    return roots;
  }
  const int scene = std::max(document.model.defaultScene, 0);
  const std::string place = fmt::format("/scenes/{}/nodes", scene);
  std::set<int> listed;
  for (const int node : entry(document.model.scenes, scene).nodes) {
    if (const int parent = entry(parents, node); parent != kNone)
      reject(document.file, place, fmt::format("node {}, a child of node {}", node, parent),
             "root nodes");
    if (!listed.insert(node).second)
      reject(document.file, place, fmt::format("node {} twice", node), "each node once");
    roots.push_back(node);
  }
  return roots;
}

std::vector<glm::dmat4> read_inverse_binds(const GltfDocument& document, int accessor,
                                           std::size_t joints, const std::string& place) {
  if (accessor < 0) return std::vector<glm::dmat4>(joints, glm::dmat4(1.0));
  const GltfAccessor from(document, accessor, place, {TINYGLTF_TYPE_MAT4}, kFloats);
  if (from.count() < joints) {
    reject(document.file, place, fmt::format("{} matrices", from.count()),
           fmt::format("one for each of {} joints", joints));
  }
  std::vector<glm::dmat4> made(joints);
  for (std::size_t i = 0; i < joints; ++i) {
    for (int k = 0; k < 16; ++k) made[i][k / 4][k % 4] = from.finite(i, k);
  }
  return made;
}

}  // namespace

std::vector<std::optional<glm::dmat4>> read_instances(const GltfDocument& document, int node,
                                                      std::size_t& budget, Notes& notes) {
  const tinygltf::Node& source = entry(document.model.nodes, node);
  const auto found = source.extensions.find(kExtension);
  if (found == source.extensions.end()) return {std::nullopt};
  const tinygltf::Value& attributes = found->second.Get("attributes");
  const InstanceReader reader(document, node, attributes);
  if (reader.count() > budget) {
    reject(document.file, reader.place(), fmt::format("{} more instances", reader.count()),
           fmt::format("at most {} in all", bounds::kInstances));
  }
  budget -= reader.count();
  if (const auto others = others_in(attributes); !others.empty())
    notes.add(fmt::format("{}: not read: {}", reader.place(), fmt::join(others, ", ")));
  if (source.skin >= 0) {
    notes.add(fmt::format("{}: a skin places the mesh, which is drawn once", reader.place()));
    return {std::nullopt};
  }
  std::vector<std::optional<glm::dmat4>> made;
  made.reserve(reader.count());
  for (std::size_t i = 0; i < reader.count(); ++i) made.push_back(reader.matrix(i));
  return made;
}

NodeTree read_nodes(const GltfDocument& document, const std::map<int, NodeCurves>& curves,
                    const glm::dmat4& root, Notes& notes) {
  NodeTree tree;
  tree.file = document.file;
  tree.root = root;
  struct Pending {
    int index, depth;
    std::optional<std::size_t> parent;
  };
  std::vector<Pending> pending;
  const auto push = [&](const std::vector<int>& nodes, int depth,
                        std::optional<std::size_t> parent) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
      pending.push_back({*node, depth, parent});
  };
  push(root_nodes(document, find_parents(document), notes), 1, std::nullopt);
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    if (next.depth > bounds::kNodeDepth) {
      reject(document.file, place_of(next.index), fmt::format("{} levels deep", next.depth),
             fmt::format("at most {}", bounds::kNodeDepth));
    }
    TreeNode node = make_node(document, next.index, curves);
    node.parent = next.parent;
    if (next.parent && tree.nodes[*next.parent].moves) node.moves = true;
    tree.nodes.push_back(std::move(node));
    push(entry(document.model.nodes, next.index).children, next.depth + 1, tree.nodes.size() - 1);
  }
  return tree;
}

SkinReader::SkinReader(const GltfDocument& document, const NodeTree& tree)
    : document_(document), in_tree_(document.model.nodes.size()) {
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) in_tree_[tree.nodes[i].index] = i;
}

std::shared_ptr<const Skin> SkinReader::read(int index) {
  std::shared_ptr<const Skin>& cached = skins_[index];
  if (cached) return cached;
  const tinygltf::Skin& source = entry(document_.model.skins, index);
  const std::string place = fmt::format("/skins/{}", index);
  joints_ += source.joints.size();
  if (joints_ > bounds::kJoints) {
    reject(document_.file, place + "/joints", fmt::format("{} joints so far", joints_),
           fmt::format("at most {} in all skins", bounds::kJoints));
  }
  Skin skin;
  for (const int joint : source.joints) {
    const std::optional<std::size_t> node = entry(in_tree_, joint);
    if (!node)
      reject(document_.file, place + "/joints", fmt::format("node {}", joint),
             "nodes of the scene");
    skin.joints.push_back(*node);
  }
  skin.inverse_binds = read_inverse_binds(document_, source.inverseBindMatrices, skin.joints.size(),
                                          place + "/inverseBindMatrices");
  return cached = std::make_shared<const Skin>(std::move(skin));
}

}  // namespace clpv
