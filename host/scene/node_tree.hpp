// SPDX-License-Identifier: MIT
// Node tree and skins of a model, and their transforms at a time. Independent of the document.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/curve.hpp"

namespace clpv {

/// Translation, rotation and scale, applied in the order scale, rotation, translation.
struct Pose {
  std::optional<glm::dvec3> translation, scale;
  std::optional<glm::dquat> rotation;  ///< unit
  glm::dmat4 matrix() const;
};

/// Animation curves of a node; null for properties without one.
struct NodeCurves {
  std::shared_ptr<const Curve> translation, rotation, scale;
  std::shared_ptr<const Curve> weights;  ///< weights of the mesh's morph targets
  bool moves() const { return translation || rotation || scale; }
};

struct TreeNode {
  int index = 0;                      ///< in the document; below 0: of a mesh in memory
  std::optional<std::size_t> parent;  ///< position in NodeTree::nodes; parents come first
  glm::dmat4 rest{1.0};               ///< transform to the parent's space, without curves
  Pose pose;                          ///< values of properties without a curve, for animated nodes
  NodeCurves curves;
  bool moves = false;  ///< true if the node or an ancestor is animated
};

/// "/nodes/3" for messages; "transform" of a mesh in memory.
std::string place_of(const TreeNode& node);

struct NodeTree {
  std::string file;  ///< for messages
  glm::dmat4 root{1.0};
  std::vector<TreeNode> nodes;

  /// Transforms of all nodes to world space, in order. Throws Error(bad_input) for transforms that
  /// are not finite, and for splines of rotations with a length below 0.5.
  std::vector<glm::dmat4> to_world(double seconds) const;
};

struct Skin {
  std::vector<std::size_t> joints;  ///< positions in NodeTree::nodes
  /// One per joint: from the mesh's space to the joint's space.
  std::vector<glm::dmat4> inverse_binds;
};

/// A tree at a time: transforms of nodes and of joints. Borrows the tree.
class PosedTree {
 public:
  /// Throws as NodeTree::to_world().
  PosedTree(const NodeTree& tree, double seconds)
      : tree_(tree), seconds_(seconds), to_world_(tree.to_world(seconds)) {}

  const NodeTree& tree() const { return tree_; }
  double seconds() const { return seconds_; }
  const glm::dmat4& to_world(std::size_t node) const { return to_world_[node]; }

  /// Transform of a camera or light, which ignores its node's scale (glTF 2.0, section 3.10.2):
  /// to_world() as if no number of that scale were negative. Their axes have no lengths.
  glm::dmat4 unmirrored(std::size_t node) const;

  /// Joint matrices of a skin, one per joint, from the mesh's space to world space.
  std::span<const glm::dmat4> joints(const Skin& skin);

 private:
  const NodeTree& tree_;
  double seconds_;
  std::vector<glm::dmat4> to_world_;
  std::map<const Skin*, std::vector<glm::dmat4>> joints_;
};

}  // namespace clpv
