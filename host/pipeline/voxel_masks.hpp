// SPDX-License-Identifier: MIT
// What a scene's triangles leave in the cells of cascades, made anew only in cells that are new to a cascade and where
// something moved (kernels/voxel_masks.cl).
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "kernels/shared/region.h"
#include "pipeline/scene_buffers.hpp"

namespace clpv {

inline constexpr std::size_t kMaskGroup = 64;  // work-items per group

static_assert(sizeof(ClpvRegion) == CLPV_SIZEOF_REGION);

/// Masks of a cascade: 32-bit words, so many a cell, cells along x first.
struct VoxelMaskShape {
  int cells;             ///< along each axis
  int valid;             ///< of these, the first ones, which may hold masks; the others hold zeros
  std::size_t words;     ///< a cell
  std::size_t cascades;  ///< 1: of whichever it was last brought to, made anew where it moved

  std::size_t words_a_cascade() const;
  std::size_t bytes() const { return words_a_cascade() * cascades * sizeof(cl_uint); }
};

class VoxelMasks {
 public:
  /// `scene` must stay as it is, but for upload_moving(). `most`: triangles a launch, of which some device may need seconds
  /// otherwise. Throws Error(run_time) where the device's memory does not suffice.
  VoxelMasks(Session& session, const SceneBuffers& scene, const VoxelMaskShape& shape, unsigned most,
             const std::string& what);

  /// Updates a cascade's masks for the position of `grid` and the present scene. `voxelize`: a kernel that sets masks of the
  /// region's cells from triangles in any order. Its arguments are the region, the clusters (clpv_triangle_number of
  /// kernels/region.h), the scene's triangles, and `rest`.
  template <KernelArgument... Rest>
  void update(std::size_t cascade, const ClpvGrid& grid, Kernel& voxelize, const Rest&... rest) {
    const std::optional<ClpvRegion> region = prepare(cascade, grid);
    if (!region) return;
    const unsigned step = std::max(most_ / CLPV_CLUSTER, 1u);
    for (unsigned first = 0; first < near_; first += step) {
      const cl_uint count = std::min(near_ - first, step);
      voxelize.set(*region, clusters_, cl_uint{first}, count, scene_.triangle_count, scene_.vertices,
                   scene_.triangles, scene_.materials, rest...);
      voxelize.launch(cl::NDRange(std::size_t{count} * CLPV_CLUSTER), cl::NDRange(CLPV_CLUSTER));
    }
  }

  /// Of all cascades, finest first.
  const Buffer& buffer() const { return masks_; }
  /// Which of `VoxelMaskShape::cascades` a cascade's are.
  cl_uint slot(std::size_t cascade) const;

 private:
  struct State {  ///< what a cascade's masks are of
    ClpvRegion place;
    unsigned instant;
  };
  std::optional<ClpvRegion> prepare(std::size_t cascade, const ClpvGrid& grid);
  ClpvRegion stale(const State& state, ClpvRegion place) const;
  void add_new_cells(ClpvRegion& region) const;
  void add_moved(ClpvRegion& region) const;
  void add_box(ClpvRegion& region, const ClpvBox& box) const;
  ClpvRegion whole(ClpvRegion place) const;
  bool is_whole(const ClpvRegion& region) const;
  void clear(std::size_t cascade, const ClpvRegion& region);
  void list_runs(const ClpvRegion& region);

  Session& session_;
  SceneBuffers scene_;
  VoxelMaskShape shape_;
  unsigned most_, near_ = 0;  ///< near_: clusters listed
  std::vector<std::optional<State>> states_;
  Buffer masks_, spare_, clusters_;
  Kernel move_, clear_;
};

}  // namespace clpv
