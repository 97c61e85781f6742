// SPDX-License-Identifier: MIT
// Stage `visibility`: tests which cell centres triangles occlude (kernels/voxels/visibility.cl;
// docs/method.md, 'Gathering').
#pragma once

#include <cstddef>

#include "pipeline/voxels/voxel_field.hpp"

namespace clpv {

/// Occlusion bits of the eight cells around each of 64 points in every cube between cell centres.
/// Each point has one byte, in the order of kernels/voxels/visibility.cl. No volume follows from
/// them.
VoxelKind visibility_masks(int grid, int cascades);

/// Size of one cascade's bits [bytes].
std::size_t visibility_bytes(int grid);

}  // namespace clpv
