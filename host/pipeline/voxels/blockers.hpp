// SPDX-License-Identifier: MIT
// Stage `blockers`: voxelises triangles into geometry volumes (kernels/voxels/blockers.cl;
// docs/method.md, 'Blockers').
#pragma once

#include "pipeline/voxels/voxel_field.hpp"

namespace clpv {

/// Geometry volumes of areas (Blocking::areas): (grid + 1)^3 samples of 3 numbers of `format`, one
/// channel. Each is the share of a square that triangles cover. Overlapping triangles count once.
VoxelKind blocker_masks(const SceneBuffers& scene, int grid, int cascades,
                        const VolumeFormat& format);

}  // namespace clpv
