// SPDX-License-Identifier: MIT
// Skins: vertices that go with several nodes, each by a share.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <vector>

#include "scene/node_tree.hpp"

namespace clpv {

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
