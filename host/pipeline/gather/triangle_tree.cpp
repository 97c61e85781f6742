// SPDX-License-Identifier: MIT
#include "pipeline/gather/triangle_tree.hpp"

#include <algorithm>
#include <bit>
#include <deque>
#include <memory>
#include <span>

#include "support/error.hpp"

#if CLPV_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace clpv {
namespace {

constexpr int kFixed = 0, kMoving = 1;  // children of the root

/// A node of Embree's tree: an inner one, or a leaf with triangles.
struct BuiltNode {
  std::array<BuiltNode*, CLPV_TREE_WIDTH> children{};
  std::array<Bounds, CLPV_TREE_WIDTH> bounds{};
  unsigned count = 0;
  std::vector<std::uint32_t> triangles;  ///< of a leaf
};

/// Callbacks of the builder. One thread builds, so the pool needs no lock and the tree is always
/// the same.
using Pool = std::deque<BuiltNode>;

void* create_node(RTCThreadLocalAllocator, unsigned count, void* pool) {
  BuiltNode& node = static_cast<Pool*>(pool)->emplace_back();
  node.count = count;
  return &node;
}

void set_children(void* to, void** children, unsigned count, void*) {
  auto& node = *static_cast<BuiltNode*>(to);
  for (unsigned i = 0; i < count; ++i) node.children[i] = static_cast<BuiltNode*>(children[i]);
}

void set_bounds(void* to, const RTCBounds** bounds, unsigned count, void*) {
  auto& node = *static_cast<BuiltNode*>(to);
  for (unsigned i = 0; i < count; ++i) {
    const RTCBounds& b = *bounds[i];
    node.bounds[i] = {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
  }
}

void* create_leaf(RTCThreadLocalAllocator, const RTCBuildPrimitive* triangles, std::size_t count,
                  void* pool) {
  BuiltNode& leaf = static_cast<Pool*>(pool)->emplace_back();
  for (std::size_t i = 0; i < count; ++i) leaf.triangles.push_back(triangles[i].primID);
  return &leaf;
}

void check_embree(RTCDevice device, bool built) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE && built) return;
  throw Error(ExitCode::run_time, "tree of triangles: Embree: error {}", static_cast<int>(error));
}

glm::vec3 corner_of(const SceneData& scene, std::uint32_t triangle, int i) {
  const float* p = scene.vertices[scene.triangles[triangle].vertex[i]].position;
  return {p[0], p[1], p[2]};
}

Bounds bounds_of_triangle(const SceneData& scene, std::uint32_t triangle) {
  const glm::vec3 a = corner_of(scene, triangle, 0), b = corner_of(scene, triangle, 1),
                  c = corner_of(scene, triangle, 2);
  return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

/// Splits the box about a triangle, or about a part of one.
void split(const RTCBuildPrimitive* part, unsigned axis, float position, RTCBounds* before,
           RTCBounds* after, void*) {
  *before = *after = {part->lower_x, part->lower_y, part->lower_z, 0,
                      part->upper_x, part->upper_y, part->upper_z, 0};
  float *const upper[] = {&before->upper_x, &before->upper_y, &before->upper_z},
               *const lower[] = {&after->lower_x, &after->lower_y, &after->lower_z};
  *upper[axis] = *lower[axis] = position;
}

/// Moving triangles are not cut in parts.
RTCBuildQuality quality_for(std::size_t triangles, bool moves, const TreeLimits& limits) {
  if (triangles <= limits.parts && !moves) return RTC_BUILD_QUALITY_HIGH;
  return triangles <= limits.areas ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_LOW;
}

BuiltNode* build(const SceneData& scene, const std::vector<std::uint32_t>& triangles, bool moves,
                 const TreeLimits& limits, Pool& pool) {
  const std::unique_ptr<std::remove_pointer_t<RTCDevice>, void (*)(RTCDevice)> device(
      rtcNewDevice("threads=1,set_affinity=0"), rtcReleaseDevice);
  if (!device) check_embree(nullptr, false);
  const std::unique_ptr<std::remove_pointer_t<RTCBVH>, void (*)(RTCBVH)> tree(
      rtcNewBVH(device.get()), rtcReleaseBVH);
  check_embree(device.get(), tree != nullptr);
  const RTCBuildQuality quality = quality_for(triangles.size(), moves, limits);
  const bool parts = quality == RTC_BUILD_QUALITY_HIGH;
  std::vector<RTCBuildPrimitive> primitives;
  primitives.reserve(parts ? triangles.size() * 5 / 4 : triangles.size());
  for (const std::uint32_t triangle : triangles) {
    const Bounds b = bounds_of_triangle(scene, triangle);
    primitives.push_back(
        {b.lower.x, b.lower.y, b.lower.z, 0, b.upper.x, b.upper.y, b.upper.z, triangle});
  }
  if (parts) primitives.resize(triangles.size() * 5 / 4);
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.buildQuality = quality;
  arguments.splitPrimitive = split;
  arguments.maxBranchingFactor = CLPV_TREE_WIDTH;
  arguments.maxDepth = CLPV_TREE_DEPTH - 2;  // without the root that joins two trees
  // Leaves for moving triangles are smaller, since their boxes overlap more.
  arguments.sahBlockSize = moves ? CLPV_TREE_WIDTH / 2 : CLPV_TREE_WIDTH;
  arguments.minLeafSize = moves ? CLPV_TREE_WIDTH / 4 : CLPV_TREE_WIDTH;
  arguments.maxLeafSize = CLPV_TREE_WIDTH;
  arguments.bvh = tree.get();
  arguments.primitives = primitives.data();
  arguments.primitiveCount = triangles.size();
  arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = create_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = create_leaf;
  arguments.userPtr = &pool;
  auto* root = static_cast<BuiltNode*>(rtcBuildBVH(&arguments));
  check_embree(device.get(), root != nullptr);
  return root;
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

/// Writes a tree of Embree's in rows.
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
  Pool pool;
  BuiltNode* root = build(scene, triangles, lane == kMoving, limits_, pool);
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
