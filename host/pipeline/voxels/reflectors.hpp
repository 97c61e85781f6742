// SPDX-License-Identifier: MIT
// Stage `reflectors`: voxelises the albedo of triangles per face direction (kernels/voxels/reflectors.cl; docs/method.md,
// 'More bounces').
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/voxels/voxel_masks.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Reflectance of the faces of light cells: six numbers in [0, 1] per channel, for +x, -x, +y, -y, +z, -z. Each is the
/// covered share of the face times mean albedo. Deterministic: sums are integers, and their order does not matter.
class ReflectorVoxelizer {
 public:
  /// Computes volumes of `format` for `cascades` cascades of `grid` cells along each axis. `scene` must not change
  /// except by upload_moving(). Throws Error(run_time) if device memory does not suffice.
  ReflectorVoxelizer(Session& session, const SceneBuffers& scene, int grid, int cascades,
                     const VolumeFormat& format);

  /// Recomputes the reflectors of a cascade.
  void voxelize(std::size_t cascade, const ClpvGrid& grid);

  /// kCellFaces numbers per cell, three channels.
  const Volume& reflectors(std::size_t cascade) const { return *reflectors_[cascade]; }

 private:
  SceneBuffers scene_;
  int grid_;
  std::vector<std::unique_ptr<Volume>> reflectors_;
  VoxelMasks sides_;
  Kernel triangles_, shares_;
};

}  // namespace clpv
