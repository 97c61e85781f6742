// SPDX-License-Identifier: MIT
// Builds the tree of triangles at medians: for a build without Embree, and as a second opinion.
#include <algorithm>
#include <span>

#include "pipeline/gather/tree_builders.hpp"

namespace clpv {
namespace {

struct BoxedTriangle {
  Bounds box;
  std::uint32_t triangle = 0;
  glm::vec3 centre() const { return (box.lower + box.upper) / 2.0f; }
};
using Part = std::span<BoxedTriangle>;

Bounds box_of(Part part) {
  Bounds all = part.front().box;
  for (const BoxedTriangle& t : part)
    all = {glm::min(all.lower, t.box.lower), glm::max(all.upper, t.box.upper)};
  return all;
}

/// Axis along which the centres lie farthest apart.
int longest_axis(Part part) {
  glm::vec3 lower = part.front().centre(), upper = lower;
  for (const BoxedTriangle& t : part)
    lower = glm::min(lower, t.centre()), upper = glm::max(upper, t.centre());
  const glm::vec3 size = upper - lower;
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

BuiltNode* build(Part part, TreePool& pool) {
  BuiltNode& node = pool.emplace_back();
  if (part.size() <= CLPV_TREE_WIDTH) {
    for (const BoxedTriangle& t : part) node.triangles.push_back(t.triangle);
    return &node;
  }
  std::vector<Part> parts{part};
  while (parts.size() < CLPV_TREE_WIDTH) {
    const auto largest = std::ranges::max_element(parts, {}, &Part::size);
    if (largest->size() <= CLPV_TREE_WIDTH) break;
    const Part whole = *largest;
    const auto middle = whole.begin() + static_cast<std::ptrdiff_t>(whole.size() / 2);
    const int axis = longest_axis(whole);
    std::ranges::nth_element(whole, middle, [axis](const auto& a, const auto& b) {
      const float x = a.centre()[axis], y = b.centre()[axis];
      return x < y || (x == y && a.triangle < b.triangle);
    });
    *largest = {whole.begin(), middle};
    parts.emplace_back(middle, whole.end());
  }
  for (const Part& child : parts) {
    node.bounds[node.count] = box_of(child);
    node.children[node.count++] = build(child, pool);
  }
  return &node;
}

}  // namespace

BuiltNode* build_by_medians(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                            bool /*moves*/, const TreeLimits& /*limits*/, TreePool& pool) {
  std::vector<BoxedTriangle> boxed;
  boxed.reserve(triangles.size());
  for (const std::uint32_t triangle : triangles)
    boxed.push_back({bounds_of_triangle(scene, triangle), triangle});
  return build(boxed, pool);
}

}  // namespace clpv
