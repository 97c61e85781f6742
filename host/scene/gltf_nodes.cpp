// SPDX-License-Identifier: MIT
#include "scene/gltf_nodes.hpp"

#include <glm/gtc/type_ptr.hpp>

#include "scene/bounds.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kNone = -1;

std::string place_of(int node) {
  return fmt::format("/nodes/{}", node);
}

/// Each node's parent. A graph in which every node has at most one parent and every chain of parents ends is
/// a forest.
std::vector<int> find_parents(const GltfDocument& document) {
  std::vector<int> parents(document.model.nodes.size(), kNone);
  for (std::size_t i = 0; i < parents.size(); ++i) {
    for (const int child : document.model.nodes[i].children) {
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent != kNone) {
        refuse(document.file, place_of(child), fmt::format("parents {} and {}", parent, i),
               "one parent at most");
      }
      parent = static_cast<int>(i);
    }
  }
  return parents;
}

void check_forest(const GltfDocument& document, const std::vector<int>& parents) {
  std::vector<int> depths(parents.size(), 0);  // 0: not known yet; a root's is 1
  for (std::size_t i = 0; i < parents.size(); ++i) {
    std::vector<int> chain;
    int node = static_cast<int>(i);
    while (node != kNone && depths[static_cast<std::size_t>(node)] == 0) {
      if (chain.size() > parents.size()) {
        refuse(document.file, place_of(node), "a cycle in the node graph", "a tree");
      }
      chain.push_back(node);
      node = parents[static_cast<std::size_t>(node)];
    }
    int depth = node == kNone ? 0 : depths[static_cast<std::size_t>(node)];
    for (auto link = chain.rbegin(); link != chain.rend(); ++link)
      depths[static_cast<std::size_t>(*link)] = ++depth;
    if (depth > bounds::kNodeDepth) {
      refuse(document.file, place_of(static_cast<int>(i)), fmt::format("{} levels deep", depth),
             fmt::format("at most {}", bounds::kNodeDepth));
    }
  }
}

Pose stored_pose(const tinygltf::Node& node, const std::string& file, int index) {
  Pose pose;
  if (!node.translation.empty()) pose.translation = glm::make_vec3(node.translation.data());
  if (!node.scale.empty()) pose.scale = glm::make_vec3(node.scale.data());
  if (!node.rotation.empty()) {  // glTF: x, y, z, w
    const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (glm::length(rotation) < 0.5) {
      refuse(file, place_of(index) + "/rotation",
             fmt::format("a quaternion of length {}", glm::length(rotation)), "a unit quaternion");
    }
    pose.rotation = glm::normalize(rotation);
  }
  return pose;
}

TreeNode make_node(const GltfDocument& document, int index, const std::map<int, NodeCurves>& curves) {
  const tinygltf::Node& source = document.model.nodes[static_cast<std::size_t>(index)];
  TreeNode made;
  made.index = index;
  made.pose = stored_pose(source, document.file, index);
  made.still = source.matrix.empty() ? made.pose.matrix() : glm::make_mat4(source.matrix.data());
  if (const auto found = curves.find(index); found != curves.end()) made.curves = found->second;
  made.moves = made.curves.moves();
  return made;
}

std::vector<int> root_nodes(const GltfDocument& document, const std::vector<int>& parents) {
  std::vector<int> roots;
  if (document.model.scenes.empty()) {
    for (std::size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] == kNone) roots.push_back(static_cast<int>(i));
    }
    return roots;
  }
  const int chosen = std::max(document.model.defaultScene, 0);
  std::vector<bool> seen(parents.size(), false);
  for (const int node : document.model.scenes[static_cast<std::size_t>(chosen)].nodes) {
    const auto i = static_cast<std::size_t>(node);
    const std::string place = fmt::format("/scenes/{}/nodes", chosen);
    if (parents[i] != kNone) {
      refuse(document.file, place, fmt::format("node {}, a child of node {}", node, parents[i]),
             "root nodes");
    }
    if (seen[i]) refuse(document.file, place, fmt::format("node {} twice", node), "each node once");
    seen[i] = true;
    roots.push_back(node);
  }
  return roots;
}

}  // namespace

NodeTree read_nodes(const GltfDocument& document, const std::map<int, NodeCurves>& curves,
                    const glm::dmat4& root) {
  const std::vector<int> parents = find_parents(document);
  check_forest(document, parents);
  NodeTree tree;
  tree.file = document.file;
  tree.root = root;
  struct Pending {
    int index;
    std::optional<std::size_t> parent;
  };
  std::vector<Pending> pending;
  const auto push = [&](const std::vector<int>& nodes, std::optional<std::size_t> parent) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) pending.push_back({*node, parent});
  };
  push(root_nodes(document, parents), std::nullopt);
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    TreeNode node = make_node(document, next.index, curves);
    node.parent = next.parent;
    if (next.parent && tree.nodes[*next.parent].moves) node.moves = true;
    tree.nodes.push_back(std::move(node));
    push(document.model.nodes[static_cast<std::size_t>(next.index)].children, tree.nodes.size() - 1);
  }
  return tree;
}

}  // namespace clpv
