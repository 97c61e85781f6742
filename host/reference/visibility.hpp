// SPDX-License-Identifier: MIT
// CPU reference of stage `visibility` (kernels/voxels/visibility.cl): cells occluded from points
// between them, in double (docs/method.md, 'Gathering').
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared/grid.h"
#include "scene/scene.hpp"

namespace clpv::reference {

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
