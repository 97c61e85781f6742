// SPDX-License-Identifier: MIT
// CPU reference of stage `blockers` (kernels/voxels/blockers.cl): geometry volume from triangles,
// in double (docs/method.md, 'Blockers').
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared/grid.h"
#include "reference/volume.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// Bounds on the covered shares [0, 1] of blocker_masks(): 3 numbers per corner, one channel.
/// Rounding decides whether a sample very close to an edge, a cell boundary or an alpha cutoff is
/// covered: `lower` excludes and `upper` includes it.
struct BlockerBounds {
  Volume lower, upper;
};

/// Returns the bounds for n + 1 corners of the cells along each axis.
BlockerBounds voxelize_blockers(const SceneData& scene, const ClpvGrid& grid);

// CPU reference of stage `reflectors` (kernels/voxels/reflectors.cl): reflecting areas of cell
// faces, in double (docs/method.md, 'More bounces').

/// Reflecting areas of reflector_masks(): R_a of six faces per cell, in the channels of
/// kernels/voxels/face_albedo.cl.
struct ReflectingAreas {
  Volume areas;
  /// Tolerance of each number: rounding decides whether samples very close to an edge, a cell
  /// boundary or an alpha cutoff are covered.
  Volume tolerance;
};

/// Returns R_a for the grid's cells.
ReflectingAreas voxelize_reflectors(const SceneData& scene, const ClpvGrid& grid,
                                    bool white = false);

// CPU reference of stage `visibility` (kernels/voxels/visibility.cl): cells occluded from points
// between them, in double (docs/method.md, 'Gathering').

/// Bounds on the bits of visibility_masks(): one byte per point, one bit per cell of its cube, set
/// if a triangle crosses the segment between them. Rounding decides where a segment ends very close
/// to a triangle or passes very close to its edge: `lower` excludes those bits, `upper` includes
/// them.
struct Occlusion {
  std::vector<std::uint8_t> lower, upper;
};

/// Returns the bounds for all cubes of the grid: [cube z][y][x][point], 64 points per cube.
Occlusion occlude(const SceneData& scene, const ClpvGrid& grid);

}  // namespace clpv::reference
