// SPDX-License-Identifier: MIT
#include "pipeline/gather/triangle_tree.hpp"

#include <algorithm>
#include <bit>
#include <span>

#include "pipeline/gather/tree_builders.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kFixed = 0, kMoving = 1;  // children of the root

glm::vec3 corner_of(const SceneData& scene, std::uint32_t triangle, int i) {
  const float* p = scene.vertices[scene.triangles[triangle].vertex[i]].position;
  return {p[0], p[1], p[2]};
}

void set_box(std::vector<TreeRow>& nodes, std::size_t node, int lane, const Bounds& box) {
  TreeRow* rows = &nodes[node * CLPV_TREE_NODE_ROWS];
  for (int axis = 0; axis < 3; ++axis) {
    rows[CLPV_TREE_LOWER + axis][lane] = box.lower[axis];
    rows[CLPV_TREE_UPPER + axis][lane] = box.upper[axis];
  }
}

/// Appends a node without children.
std::size_t append_node(std::vector<TreeRow>& nodes) {
  const std::size_t node = nodes.size() / CLPV_TREE_NODE_ROWS;
  nodes.resize(nodes.size() + CLPV_TREE_NODE_ROWS, TreeRow{});
  for (int lane = 0; lane < CLPV_TREE_WIDTH; ++lane)
    set_box(nodes, node, lane, {glm::vec3(CLPV_TREE_FAR), glm::vec3(-CLPV_TREE_FAR)});
  return node;
}

void set_child(std::vector<TreeRow>& nodes, std::size_t node, int lane, int child) {
  nodes[node * CLPV_TREE_NODE_ROWS + CLPV_TREE_CHILDREN][lane] = std::bit_cast<float>(child);
}

void append_leaf(const SceneData& scene, std::span<const std::uint32_t> triangles,
                 std::vector<TreeRow>& leaves) {
  const std::size_t first = leaves.size();
  leaves.resize(first + CLPV_TREE_LEAF_ROWS, TreeRow{});
  TreeRow* rows = &leaves[first];
  for (std::size_t lane = 0; lane < triangles.size(); ++lane) {
    const std::uint32_t triangle = triangles[lane];
    const glm::vec3 a = corner_of(scene, triangle, 0), edge1 = corner_of(scene, triangle, 1) - a,
                    edge2 = corner_of(scene, triangle, 2) - a;
    for (int axis = 0; axis < 3; ++axis) {
      rows[CLPV_TREE_CORNER + axis][lane] = a[axis];
      rows[CLPV_TREE_EDGE1 + axis][lane] = edge1[axis];
      rows[CLPV_TREE_EDGE2 + axis][lane] = edge2[axis];
    }
    const bool masked =
        (scene.materials[scene.triangles[triangle].material].flags & CLPV_MATERIAL_MASKED) != 0;
    rows[CLPV_TREE_TRIANGLES][lane] =
        std::bit_cast<float>(triangle | (masked ? CLPV_TREE_MASKED : 0u));
  }
}

/// Writes a tree in rows.
struct Flattener {
  const SceneData& scene;
  std::vector<TreeRow>&nodes, &leaves;

  /// Returns the number of the child, and sorts triangles of leaves, whose order the builder does
  /// not define.
  int append(BuiltNode& built, int depth) const {
    if (depth > CLPV_TREE_DEPTH)
      throw Error(ExitCode::run_time, "tree of triangles: more than {} levels", CLPV_TREE_DEPTH);
    if (built.count == 0) {
      std::ranges::sort(built.triangles);
      append_leaf(scene, built.triangles, leaves);
      return ~static_cast<int>(leaves.size() / CLPV_TREE_LEAF_ROWS - 1);
    }
    const std::size_t node = append_node(nodes);
    for (unsigned lane = 0; lane < built.count; ++lane) {
      const int child = append(*built.children[lane], depth + 1);
      set_box(nodes, node, lane, built.bounds[lane]);
      set_child(nodes, node, lane, child);
    }
    return static_cast<int>(node);
  }
};

}  // namespace

Bounds bounds_of_triangle(const SceneData& scene, std::uint32_t triangle) {
  const glm::vec3 a = corner_of(scene, triangle, 0), b = corner_of(scene, triangle, 1),
                  c = corner_of(scene, triangle, 2);
  return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

TriangleTree::TriangleTree(const SceneData& scene, const TreeLimits& limits) : limits_(limits) {
  std::vector<bool> moves(scene.triangles.size(), false);
  for (const MeshRange& part : scene.moving) {
    std::fill_n(moves.begin() + part.first_triangle, part.triangles, true);
  }
  std::vector<std::uint32_t> fixed;
  for (std::uint32_t i = 0; i < moves.size(); ++i) (moves[i] ? moving_ : fixed).push_back(i);
  append_node(nodes_);
  add(scene, fixed, kFixed);
  fixed_nodes_ = nodes_.size();
  fixed_leaves_ = leaves_.size();
  move(scene);
}

void TriangleTree::move(const SceneData& scene) {
  nodes_.resize(fixed_nodes_);
  leaves_.resize(fixed_leaves_);
  add(scene, moving_, kMoving);
}

/// Adds a tree of triangles as child `lane` of the root.
void TriangleTree::add(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                       int lane) {
  if (triangles.empty()) return;
  TreePool pool;
  BuiltNode* root = (limits_.medians ? build_by_medians : build_by_areas)(
      scene, triangles, lane == kMoving, limits_, pool);
  const int child = Flattener{scene, nodes_, leaves_}.append(*root, 2);
  Bounds box = bounds_of_triangle(scene, triangles.front());
  for (const std::uint32_t triangle : triangles) {
    const Bounds b = bounds_of_triangle(scene, triangle);
    box = {glm::min(box.lower, b.lower), glm::max(box.upper, b.upper)};
  }
  set_box(nodes_, 0, lane, box);
  set_child(nodes_, 0, lane, child);
}

}  // namespace clpv
