// SPDX-License-Identifier: MIT
// Where a scene's triangles are, run by run, and where they moved: what lies elsewhere need not be gone through.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.hpp"

namespace clpv {

/// Of the vertices that `triangles` use; they must exist. A box of no extent at the origin where there are none.
Bounds bounds_of(const std::vector<Vertex>& vertices, std::span<const Triangle> triangles);

/// A run is CLPV_CLUSTER triangles that follow each other in a scene, the last one shorter.
class TriangleClusters {
 public:
  TriangleClusters() = default;
  explicit TriangleClusters(const Scene& scene);

  /// To be called when the scene shows another instant. Gives the moving parts that are not as they were.
  std::vector<MeshRange> move(const Scene& scene);

  const std::vector<Bounds>& bounds() const { return bounds_; }
  unsigned triangles() const { return triangles_; }

  /// How often something has moved, and the boxes in which something did the last time.
  unsigned instant() const { return instant_; }
  const std::vector<Bounds>& moved() const { return moved_; }
  /// As if everything had moved: what follows no single step is computed from all triangles.
  void invalidate() { instant_ += 2; }

  /// Numbers of the clusters of whose bounds `wanted` is true, in their order.
  template <typename Wanted>
  std::vector<std::uint32_t> which(const Wanted& wanted) const {
    std::vector<std::uint32_t> clusters;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      if (wanted(bounds_[i])) clusters.push_back(static_cast<std::uint32_t>(i));
    }
    return clusters;
  }

 private:
  struct Moving {
    Bounds bounds;
    std::uint64_t print;
  };
  void bound_runs(const Scene& scene, std::size_t first, std::size_t count);

  std::vector<Bounds> bounds_;
  std::vector<Moving> moving_;  ///< of Scene::moving
  std::vector<Bounds> moved_;
  unsigned triangles_ = 0, instant_ = 0;
};

}  // namespace clpv
