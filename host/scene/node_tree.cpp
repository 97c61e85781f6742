// SPDX-License-Identifier: MIT
// Evaluates transforms of nodes and joints.
#include "scene/node_tree.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "support/error.hpp"

namespace clpv {
namespace {

bool finite(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(m[column][row])) return false;
    }
  }
  return true;
}

/// Pose of an animated node.
Pose pose_at(const NodeTree& tree, const TreeNode& node, double seconds) {
  Pose pose = node.pose;
  if (node.curves.translation) pose.translation = vector_at(*node.curves.translation, seconds);
  if (node.curves.scale) pose.scale = vector_at(*node.curves.scale, seconds);
  if (node.curves.rotation) {
    pose.rotation = rotation_at(*node.curves.rotation, seconds);
    if (!(glm::length(*pose.rotation) > 0.5)) {
      reject(tree.file, fmt::format("/nodes/{}/rotation", node.index),
             fmt::format("a quaternion of length {} at {} s", glm::length(*pose.rotation), seconds),
             "splines through lengths above 0.5");
    }
  }
  return pose;
}

/// Transform of a node to its parent's space.
glm::dmat4 local_transform(const NodeTree& tree, const TreeNode& node, double seconds) {
  return node.curves.moves() ? pose_at(tree, node, seconds).matrix() : node.rest;
}

}  // namespace

std::string place_of(const TreeNode& node) {
  return node.index < 0 ? "transform" : fmt::format("/nodes/{}", node.index);
}

glm::dmat4 Pose::matrix() const {
  glm::dmat4 transform(1.0);
  if (translation) transform = glm::translate(transform, *translation);
  if (rotation) transform *= glm::mat4_cast(*rotation);
  if (scale) transform = glm::scale(transform, *scale);
  return transform;
}

std::vector<glm::dmat4> NodeTree::to_world(double seconds) const {
  std::vector<glm::dmat4> made;
  made.reserve(nodes.size());
  for (const TreeNode& node : nodes) {
    const glm::dmat4& parent = node.parent ? made[*node.parent] : root;
    made.push_back(parent * local_transform(*this, node, seconds));
    if (!finite(made.back())) {
      reject(file, place_of(node), "a transform that overflows", "finite transforms");
    }
  }
  return made;
}

glm::dmat4 PosedTree::unmirrored(std::size_t index) const {
  const TreeNode& node = tree_.nodes[index];
  Pose pose = pose_at(tree_, node, seconds_);
  if (!pose.scale || !glm::any(glm::lessThan(*pose.scale, glm::dvec3(0)))) return to_world_[index];
  pose.scale = glm::abs(*pose.scale);
  return (node.parent ? to_world_[*node.parent] : tree_.root) * pose.matrix();
}

std::span<const glm::dmat4> PosedTree::joints(const Skin& skin) {
  std::vector<glm::dmat4>& matrices = joints_[&skin];
  if (matrices.empty()) {
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
      matrices.push_back(to_world_[skin.joints[i]] * skin.inverse_binds[i]);
  }
  return matrices;
}

}  // namespace clpv
