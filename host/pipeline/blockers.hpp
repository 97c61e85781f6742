// SPDX-License-Identifier: MIT
// Stage `blockers`: voxelises triangles into geometry volumes (kernels/blockers.cl; docs/method.md, 'Blockers').
#pragma once

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/voxel_masks.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Fills geometry volumes of areas (Blocking::areas) with the share of each square that triangles cover; overlapping
/// triangles count once. Deterministic: the order in which bits are set does not matter.
class BlockerVoxelizer {
 public:
  /// For `cascades` cascades of `grid` cells along each axis, into volumes of `format`. `scene` must stay as it is,
  /// but for upload_moving(). Throws Error(run_time) where the device's memory does not suffice.
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
