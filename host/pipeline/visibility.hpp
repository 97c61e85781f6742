// SPDX-License-Identifier: MIT
// Stage `see`: what a scene's own triangles hide of the cells round a point (kernels/visibility.cl; docs/method.md, 'Gathering').
#pragma once

#include <cstddef>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/voxel_masks.hpp"

namespace clpv {

/// Which of the eight cells round each of 64 points between them are hidden: a byte a point, of every cube between the
/// centres of cells, as kernels/visibility.cl lays them out. Deterministic: bits are set in whatever order.
class CellVisibility {
 public:
  /// Of `cascades` cascades of `grid` cells along each axis. `scene` must stay as it is, but for
  /// upload_moving().
  /// Throws Error(run_time) where the device's memory does not suffice.
  CellVisibility(Session& session, const SceneBuffers& scene, int grid, int cascades);

  /// Brings what is known of a cascade to where `grid` stands and what the scene is now.
  void see(std::size_t cascade, const ClpvGrid& grid);

  /// bytes() a cascade, finest first.
  const Buffer& hidden() const { return hidden_.buffer(); }

  /// Of one cascade.
  static std::size_t bytes(int grid);

 private:
  VoxelMasks hidden_;
  Kernel triangles_;
};

}  // namespace clpv
