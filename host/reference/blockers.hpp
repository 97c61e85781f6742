// SPDX-License-Identifier: MIT
// Stage `block` in double: the CPU reference of kernels/blockers.cl.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared/grid.h"
#include "reference/volume.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// Shares [0, 1] of each corner and axis, as BlockerVoxelizer gives them: 3 numbers a sample, one channel. A sample within a
/// hair's breadth of an edge, of a border between cells, or of an alpha cutoff is covered or not by how numbers are
/// rounded: `least` has none of those, `most` has all.
struct Blocked {
  Volume least, most;
};

Blocked block(const Scene& scene, const ClpvGrid& grid);

}  // namespace clpv::reference
