// SPDX-License-Identifier: MIT
// Bounds of a scene's triangle clusters and of their motion, so that stages skip triangles outside
// a region.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.hpp"

namespace clpv {

/// Returns the bounds of the vertices that `triangles` use, which must exist. An empty box at the
/// origin without any.
Bounds bounds_of(const std::vector<Vertex>& vertices, std::span<const Triangle> triangles);

/// Centres and half edges of boxes along x, y and z, for loops that compilers vectorise.
struct Boxes {
  std::array<std::vector<float>, 3> centre, half;
};

/// Triangle clusters: CLPV_CLUSTER consecutive triangles of a scene each; the last cluster is
/// shorter.
class TriangleClusters {
 public:
  TriangleClusters() = default;
  explicit TriangleClusters(const SceneData& scene);

  /// Call when the time of the scene changes. Returns the moving parts that changed.
  std::vector<MeshRange> move(const SceneData& scene);

  const std::vector<Bounds>& bounds() const { return bounds_; }
  const Boxes& boxes() const { return boxes_; }  ///< the same
  unsigned triangles() const { return triangles_; }

  /// Version of the positions, and the boxes in which triangles moved last.
  unsigned instant() const { return instant_; }
  const std::vector<Bounds>& moved() const { return moved_; }
  /// Treats everything as moved: the next update uses all triangles, since it is not one step
  /// ahead.
  void invalidate() { instant_ += 2; }

  /// Returns the indices of the clusters whose bounds satisfy `wanted`, in order.
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
  void bound_runs(const SceneData& scene, std::size_t first, std::size_t count);

  std::vector<Bounds> bounds_;
  std::vector<Moving> moving_;  ///< one per entry of SceneData::moving
  std::vector<Bounds> moved_;
  unsigned triangles_ = 0, instant_ = 0;
  Boxes boxes_;
};

}  // namespace clpv
