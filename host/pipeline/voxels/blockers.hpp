// SPDX-License-Identifier: MIT
// Stage `blockers`: voxelises triangles into geometry volumes (kernels/voxels/blockers.cl; docs/method.md, 'Blockers').
#pragma once

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/voxels/voxel_masks.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Computes geometry volumes of areas (Blocking::areas): the share of each square that triangles cover. Overlapping
/// triangles count once. Deterministic: the order in which bits are set does not matter.
class BlockerVoxelizer {
 public:
  /// Computes volumes of `format` for `cascades` cascades of `grid` cells along each axis. `scene` must not change
  /// except by upload_moving(). Throws Error(run_time) if device memory does not suffice.
  BlockerVoxelizer(Session& session, const SceneBuffers& scene, int grid, int cascades,
                   const VolumeFormat& format);

  /// Overwrites `geometry`: (grid + 1)^3 samples of 3 numbers, one channel.
  void voxelize(std::size_t cascade, const ClpvGrid& grid, Volume& geometry);

 private:
  SceneBuffers scene_;
  int grid_;
  VoxelMasks masks_;
  Kernel triangles_, shares_;
};

}  // namespace clpv
