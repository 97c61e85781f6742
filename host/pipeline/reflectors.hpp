// SPDX-License-Identifier: MIT
// Stage `reflect`: what a scene's own triangles reflect in a cascade (kernels/reflectors.cl; docs/method.md, 'More bounces').
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/voxel_masks.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Reflecting areas of the light cells: of each channel six numbers in [0, 1], for what faces +x, -x, +y, -y, +z, -z: its area
/// in faces of a cell times its albedo. Deterministic: integers are summed, in whatever order.
class ReflectorVoxelizer {
 public:
  /// Of `cascades` cascades of `grid` cells along each axis, in volumes of `format`. `scene` must stay as it is,
  /// but for upload_moving().
  /// Throws Error(run_time) where the device's memory does not suffice.
  ReflectorVoxelizer(Session& session, const SceneBuffers& scene, int grid, int cascades,
                     const VolumeFormat& format);

  /// Makes what is known of a cascade anew.
  void reflect(std::size_t cascade, const ClpvGrid& grid);

  /// kReflectingSides numbers, three channels.
  const Volume& reflectors(std::size_t cascade) const { return *reflectors_[cascade]; }

 private:
  SceneBuffers scene_;
  int grid_;
  std::vector<std::unique_ptr<Volume>> reflectors_;
  VoxelMasks sides_;
  Kernel triangles_, shares_;
};

}  // namespace clpv
