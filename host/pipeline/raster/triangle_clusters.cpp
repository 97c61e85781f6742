// SPDX-License-Identifier: MIT
#include "pipeline/raster/triangle_clusters.hpp"

#include <algorithm>
#include <limits>

#include "kernels/shared/region.h"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

Bounds about(const Bounds& a, const Bounds& b) {
  return {glm::min(a.lower, b.lower), glm::max(a.upper, b.upper)};
}

std::uint64_t print_of(const SceneData& scene, const MeshRange& part) {
  Fingerprint print;
  add_range(print, scene, part);
  return print.value();
}

Bounds part_bounds(const SceneData& scene, const MeshRange& part) {
  return bounds_of(scene.vertices,
                   std::span(scene.triangles).subspan(part.first_triangle, part.triangles));
}

}  // namespace

Bounds bounds_of(const std::vector<Vertex>& vertices, std::span<const Triangle> triangles) {
  if (triangles.empty()) return {};
  glm::vec3 lower(std::numeric_limits<float>::max()), upper(std::numeric_limits<float>::lowest());
  for (const Triangle& triangle : triangles) {
    for (const unsigned vertex : triangle.vertex) {
      const float* at = vertices[vertex].position;
      const glm::vec3 p(at[0], at[1], at[2]);
      lower = glm::min(lower, p);
      upper = glm::max(upper, p);
    }
  }
  return {lower, upper};
}

TriangleClusters::TriangleClusters(const SceneData& scene)
    : triangles_(static_cast<unsigned>(scene.triangles.size())) {
  bounds_.resize((scene.triangles.size() + CLPV_CLUSTER - 1) / CLPV_CLUSTER);
  for (auto* side : {&boxes_.centre, &boxes_.half})
    for (std::vector<float>& along : *side) along.resize(bounds_.size());
  bound_runs(scene, 0, scene.triangles.size());
  for (const MeshRange& part : scene.moving)
    moving_.push_back({part_bounds(scene, part), print_of(scene, part)});
}

/// Updates the bounds of the clusters that contain a range of triangles.
void TriangleClusters::bound_runs(const SceneData& scene, std::size_t first, std::size_t count) {
  if (count == 0) return;
  const std::size_t last_run = (first + count - 1) / CLPV_CLUSTER;
  for (std::size_t run = first / CLPV_CLUSTER; run <= last_run; ++run) {
    const std::size_t from = run * CLPV_CLUSTER;
    const std::size_t size = std::min<std::size_t>(CLPV_CLUSTER, scene.triangles.size() - from);
    bounds_[run] = bounds_of(scene.vertices, std::span(scene.triangles).subspan(from, size));
    for (int axis = 0; axis < 3; ++axis) {
      const float lower = bounds_[run].lower[axis], upper = bounds_[run].upper[axis];
      const float centre = 0.5f * lower + 0.5f * upper;
      boxes_.centre[axis][run] = centre;
      boxes_.half[axis][run] = std::max(upper - centre, centre - lower);
    }
  }
}

std::vector<MeshRange> TriangleClusters::move(const SceneData& scene) {
  std::vector<MeshRange> changed;
  std::vector<Bounds> moved;
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const MeshRange& part = scene.moving[i];
    const std::uint64_t print = print_of(scene, part);
    if (print == moving_[i].print) continue;
    const Bounds now = part_bounds(scene, part);
    if (part.triangles > 0) moved.push_back(about(moving_[i].bounds, now));
    moving_[i] = {now, print};
    bound_runs(scene, part.first_triangle, part.triangles);
    changed.push_back(part);
  }
  if (changed.empty()) return changed;
  moved_ = std::move(moved);
  ++instant_;
  return changed;
}

}  // namespace clpv
