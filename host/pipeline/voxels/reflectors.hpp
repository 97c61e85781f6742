// SPDX-License-Identifier: MIT
// Stage `reflectors`: voxelises the albedo of triangles per face direction
// (kernels/voxels/reflectors.cl; docs/method.md, 'More bounces').
#pragma once

#include "pipeline/voxels/voxel_field.hpp"

namespace clpv {

/// Reflectance of the faces of light cells: kCellFaces numbers in [0, 1] of `format` per channel,
/// for +x, -x, +y, -y, +z, -z. Each is the covered share of the face times mean albedo; further
/// channels: kernels/voxels/face_albedo.cl. `white`: no albedo, and backs count only where the
/// material is double-sided. Masks are those of the last cascade: sums of integers, whose order
/// does not matter.
VoxelKind reflector_masks(const SceneBuffers& scene, int grid, const VolumeFormat& format,
                          bool white = false);

}  // namespace clpv
