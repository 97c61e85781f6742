// SPDX-License-Identifier: MIT
// Builds the tree of triangles by Embree.
#include <memory>

#include "pipeline/gather/tree_builders.hpp"
#include "support/error.hpp"

#if CLPV_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace clpv {
namespace {

// Callbacks of the builder.
void* create_node(RTCThreadLocalAllocator, unsigned count, void* pool) {
  BuiltNode& node = static_cast<TreePool*>(pool)->emplace_back();
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
  BuiltNode& leaf = static_cast<TreePool*>(pool)->emplace_back();
  for (std::size_t i = 0; i < count; ++i) leaf.triangles.push_back(triangles[i].primID);
  return &leaf;
}

void check_embree(RTCDevice device, bool built) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE && built) return;
  throw Error(ExitCode::run_time, "tree of triangles: Embree: error {}", static_cast<int>(error));
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

}  // namespace

BuiltNode* build_by_areas(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                          bool moves, const TreeLimits& limits, TreePool& pool) {
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

}  // namespace clpv
