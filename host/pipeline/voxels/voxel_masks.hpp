// SPDX-License-Identifier: MIT
// Incremental voxelisation: recomputes voxel masks only in cells that are new to a cascade or where triangles moved
// (kernels/voxels/voxel_masks.cl).
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "kernels/shared/region.h"
#include "pipeline/raster/scene_buffers.hpp"

namespace clpv {

inline constexpr std::size_t kMaskGroup = 64;  // work-items per group

static_assert(sizeof(ClpvRegion) == CLPV_SIZEOF_REGION);

/// Shape of a cascade's masks: 32-bit words, a fixed number per cell, cells along x first.
struct VoxelMaskShape {
  int cells;          ///< along each axis
  int valid;          ///< number of leading cells along each axis that may hold masks; the others hold zeros
  std::size_t words;  ///< words per cell
  std::size_t cascades;  ///< number of stored cascades; 1: masks of the last updated cascade only

  std::size_t words_a_cascade() const;
  std::size_t bytes() const { return words_a_cascade() * cascades * sizeof(cl_uint); }
};

class VoxelMasks {
 public:
  /// `scene` must not change except by upload_moving(). `max_triangles`: maximum number of triangles per launch, since larger
  /// launches take seconds on some devices. Throws Error(run_time) if device memory does not suffice.
  VoxelMasks(Session& session, const SceneBuffers& scene, const VoxelMaskShape& shape, unsigned max_triangles,
             const std::string& what);

  /// Updates a cascade's masks for the position of `grid` and the current scene. `voxelize`: kernel that sets masks of
  /// the region's cells from triangles in any order. Its arguments are the region, the clusters (triangle_number
  /// of kernels/voxels/region.h), the scene's triangles, and `rest`.
  template <KernelArgument... Rest>
  void update(std::size_t cascade, const ClpvGrid& grid, Kernel& voxelize, const Rest&... rest) {
    const std::optional<ClpvRegion> region = prepare(cascade, grid);
    if (!region) return;
    const unsigned step = std::max(max_triangles_ / CLPV_CLUSTER, 1u);
    for (unsigned first = 0; first < near_; first += step) {
      const cl_uint count = std::min(near_ - first, step);
      voxelize.set(*region, clusters_, cl_uint{first}, count, scene_.triangle_count, scene_.vertices,
                   scene_.triangles, scene_.materials, rest...);
      voxelize.launch(cl::NDRange(std::size_t{count} * CLPV_CLUSTER), cl::NDRange(CLPV_CLUSTER));
    }
  }

  /// Masks of all stored cascades, finest first.
  const Buffer& buffer() const { return masks_; }
  /// Returns the index of a cascade's masks among `VoxelMaskShape::cascades`.
  cl_uint slot(std::size_t cascade) const;

 private:
  struct State {  ///< inputs of a cascade's masks
    ClpvRegion place;
    unsigned instant;
  };
  std::optional<ClpvRegion> prepare(std::size_t cascade, const ClpvGrid& grid);
  ClpvRegion stale_cells(const State& state, ClpvRegion place) const;
  void add_new_cells(ClpvRegion& region) const;
  void add_moved(ClpvRegion& region) const;
  void add_box(ClpvRegion& region, const ClpvBox& box) const;
  ClpvRegion whole(ClpvRegion place) const;
  bool is_whole(const ClpvRegion& region) const;
  void clear(std::size_t cascade, const ClpvRegion& region);
  void list_clusters(const ClpvRegion& region);

  Session& session_;
  SceneBuffers scene_;
  VoxelMaskShape shape_;
  unsigned max_triangles_, near_ = 0;  ///< near_: number of listed clusters
  std::vector<std::optional<State>> states_;
  Buffer masks_, spare_, clusters_;
  Kernel move_, clear_;
};

}  // namespace clpv
