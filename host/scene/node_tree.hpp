// SPDX-License-Identifier: MIT
// A model's nodes and skins, and where they stand at any instant. Plain numbers: the document they came from may be gone.
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

/// What of a node changes with time; null: nothing.
struct NodeCurves {
  std::shared_ptr<const Curve> translation, rotation, scale;
  std::shared_ptr<const Curve> weights;  ///< of its mesh's morph targets
  bool moves() const { return translation || rotation || scale; }
};

struct TreeNode {
  int index = 0;                      ///< in the document
  std::optional<std::size_t> parent;  ///< its place in the list; parents come first
  glm::dmat4 still{1.0};              ///< to its parent's space, where no curve moves it
  Pose pose;                          ///< what the curves replace, where some do
  NodeCurves curves;
  bool moves = false;  ///< it, or one above it
};

struct NodeTree {
  std::string file;  ///< for messages
  glm::dmat4 root{1.0};
  std::vector<TreeNode> nodes;

  /// Each node's transform to world space, in their order. Throws Error(bad_input) for transforms that are not finite, and
  /// splines that lead through no rotation.
  std::vector<glm::dmat4> to_world(double seconds) const;
};

struct Skin {
  std::vector<std::size_t> joints;        ///< nodes of the tree
  std::vector<glm::dmat4> inverse_binds;  ///< one a joint: from the mesh as stored to the joint's space
};

/// A tree at an instant: where each node stands, and what each skin does to vertices.
class PosedTree {
 public:
  /// Throws as NodeTree::to_world does.
  PosedTree(const NodeTree& tree, double seconds)
      : tree_(tree), seconds_(seconds), to_world_(tree.to_world(seconds)) {}

  const NodeTree& tree() const { return tree_; }
  double seconds() const { return seconds_; }
  const glm::dmat4& to_world(std::size_t node) const { return to_world_[node]; }

  /// One matrix a joint, from the mesh as stored to world space.
  std::span<const glm::dmat4> joints(const Skin& skin);

 private:
  const NodeTree& tree_;
  double seconds_;
  std::vector<glm::dmat4> to_world_;
  std::map<const Skin*, std::vector<glm::dmat4>> joints_;
};

}  // namespace clpv
