// SPDX-License-Identifier: MIT
// Stage `see` in double: the CPU reference of kernels/visibility.cl.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared/grid.h"
#include "scene/scene.hpp"

namespace clpv::reference {

/// A byte a point and a bit a corner, as CellVisibility keeps them. Where a way ends within a hair's breadth of a triangle, or
/// passes its edge so, rounding decides: `least` has none of those bits, `most` has all.
struct Hidden {
  std::vector<std::uint8_t> least, most;
};

Hidden see(const Scene& scene, const ClpvGrid& grid);

}  // namespace clpv::reference
