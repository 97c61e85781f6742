// SPDX-License-Identifier: MIT
// Stage `visibility`: tests which cell centres triangles occlude (kernels/voxels/visibility.cl; docs/method.md, 'Gathering').
#pragma once

#include <cstddef>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/voxels/voxel_masks.hpp"

namespace clpv {

/// Occlusion bits of the eight cells around each of 64 points in every cube between cell centres. Each point has one
/// byte, in the order of kernels/voxels/visibility.cl. Deterministic: the order in which bits are set does not matter.
class CellVisibility {
 public:
  /// Allocates bits for `cascades` cascades of `grid` cells along each axis. `scene` must not change except by
  /// upload_moving(). Throws Error(run_time) if device memory does not suffice.
  CellVisibility(Session& session, const SceneBuffers& scene, int grid, int cascades);

  /// Updates the bits of a cascade for the position of `grid` and the current scene.
  void update(std::size_t cascade, const ClpvGrid& grid);

  /// Bits of all cascades, bytes() each, finest first.
  const Buffer& occluded() const { return occluded_.buffer(); }

  /// Size of one cascade's bits [bytes].
  static std::size_t bytes(int grid);

 private:
  VoxelMasks occluded_;
  Kernel triangles_;
};

}  // namespace clpv
