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

}  // namespace clpv::reference
