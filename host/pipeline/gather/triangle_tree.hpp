// SPDX-License-Identifier: MIT
// Tree of bounding boxes over the triangles of a scene, for rays on the device
// (kernels/gather/triangle_tree.h). Built on the host, without OpenCL (tree_builders.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/shared/tree.h"
#include "scene/scene.hpp"

namespace clpv {

/// A row: eight numbers, float or 32-bit integer as kernels/shared/tree.h says.
using TreeRow = std::array<float, CLPV_TREE_WIDTH>;

/// Limits of the slower builders, whose boxes overlap less. Up to `parts` triangles: by surface
/// area, triangles cut in parts; up to `areas`: by surface area. More triangles are sorted along a
/// Morton curve.
struct TreeLimits {
  std::size_t parts = 500'000, areas = 1'000'000;
  bool medians = false;  ///< halve triangles at medians instead, as a build without Embree does
};

/// Moving triangles have a tree of their own below the root, so that motion rebuilds only that.
class TriangleTree {
 public:
  /// Throws Error(run_time) if Embree fails.
  explicit TriangleTree(const SceneData& scene, const TreeLimits& limits = {});

  /// Rebuilds the tree of the moving triangles (SceneData::moving). The scene has the same
  /// triangles as before.
  void move(const SceneData& scene);

  /// CLPV_TREE_NODE_ROWS each; node 0 is the root.
  const std::vector<TreeRow>& nodes() const { return nodes_; }
  const std::vector<TreeRow>& leaves() const { return leaves_; }  ///< CLPV_TREE_LEAF_ROWS each

 private:
  void add(const SceneData& scene, const std::vector<std::uint32_t>& triangles, int lane);

  TreeLimits limits_;
  std::vector<std::uint32_t> moving_;  ///< triangles
  std::vector<TreeRow> nodes_, leaves_;
  std::size_t fixed_nodes_ = 0, fixed_leaves_ = 0;  ///< rows that motion does not change
};

}  // namespace clpv
