// SPDX-License-Identifier: MIT
// Stage `reflect` in double: the CPU reference of kernels/reflectors.cl.
#pragma once

#include "kernels/shared/grid.h"
#include "reference/volume.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// Reflecting areas as ReflectorVoxelizer gives them: six numbers a cell, three channels.
struct Reflected {
  Volume areas;
  /// How far each may be off where rounding decides whether samples within a hair's breadth of an edge, of a border between
  /// cells, or of an alpha cutoff are covered.
  Volume doubt;
};

Reflected reflect(const Scene& scene, const ClpvGrid& grid);

}  // namespace clpv::reference
