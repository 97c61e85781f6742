// SPDX-License-Identifier: MIT
// Builders of the tree of triangles (triangle_tree.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "pipeline/gather/triangle_tree.hpp"

namespace clpv {

/// A node: an inner one with `count` children, or a leaf with triangles.
struct BuiltNode {
  std::array<BuiltNode*, CLPV_TREE_WIDTH> children{};
  std::array<Bounds, CLPV_TREE_WIDTH> bounds{};
  unsigned count = 0;
  std::vector<std::uint32_t> triangles;  ///< triangles of a leaf
};

/// Owns the nodes of a tree. One thread builds, so it needs no lock and the tree is always the
/// same.
using TreePool = std::deque<BuiltNode>;

Bounds bounds_of_triangle(const SceneData& scene, std::uint32_t triangle);

/// Builds a tree of some triangles by Embree: by surface area, in which fewer boxes overlap, or,
/// beyond the limits, along a Morton curve. Throws Error(run_time) if Embree fails. Without Embree
/// (CLPV_PATHTRACER=OFF) the same as build_by_medians.
BuiltNode* build_by_areas(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                          bool moves, const TreeLimits& limits, TreePool& pool);

/// Builds a tree that halves triangles at the median of their centres along the longest axis.
BuiltNode* build_by_medians(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                            bool moves, const TreeLimits& limits, TreePool& pool);

}  // namespace clpv
