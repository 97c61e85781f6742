// SPDX-License-Identifier: MIT
// CPU reference of stage `reflectors` (kernels/voxels/reflectors.cl): reflecting areas of cell
// faces, in double (docs/method.md, 'More bounces').
#pragma once

#include "kernels/shared/grid.h"
#include "reference/volume.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

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

}  // namespace clpv::reference
