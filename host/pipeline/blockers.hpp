// SPDX-License-Identifier: MIT
// Stage `block`: what a scene's own triangles block in a cascade, whoever sees them (kernels/blockers.cl; docs/method.md,
// 'Blockers').
#pragma once

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/voxel_masks.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Fills geometry volumes of areas (Blocking::areas) from triangles, by the share of a cell's square that they cover
/// together: what covers the same is not counted twice. Deterministic: bits are set in whatever order.
class BlockerVoxelizer {
 public:
  /// Of `cascades` cascades of `grid` cells along each axis, into volumes of `format`. `scene` must stay as it is, but for
  /// upload_moving().
  /// Throws Error(run_time) where the device's memory does not suffice.
  BlockerVoxelizer(Session& session, const SceneBuffers& scene, int grid, int cascades,
                   const VolumeFormat& format);

  /// Overwrites `geometry`: grid + 1 samples a side, 3 numbers, one channel.
  void block(std::size_t cascade, const ClpvGrid& grid, Volume& geometry);

 private:
  SceneBuffers scene_;
  int grid_;
  VoxelMasks masks_;
  Kernel triangles_, shares_;
};

}  // namespace clpv
