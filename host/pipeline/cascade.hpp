// SPDX-License-Identifier: MIT
// Where the cascades' grids stand: nested round the camera, snapped to whole cells.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/grid.h"
#include "scene/scene.hpp"

namespace clpv {

static_assert(sizeof(ClpvGrid) == CLPV_SIZEOF_GRID);

/// `count` grids of `cells`^3 cells, finest first, edges `size`, 2 size, 4 size ... [m], each about `eye` [m]
/// in its middle. Origins are whole multiples of the cell, so that a camera that moves inside a cell moves no
/// grid, and light does not swim (Kaplanyan & Dachsbacher 2010, section 5).
std::vector<ClpvGrid> cascade_grids(const glm::vec3& eye, int count, double size, int cells);

/// From the coarser grid's least corner to the finer one's, in finer cells. Throws Error(run_time) where these are not half
/// as wide, or not inside.
std::array<int, 3> offset_in_coarser(const ClpvGrid& coarser, const ClpvGrid& finer);

/// The finest edge [m] that suits `scene`: `size`, where the coarsest of `count` cascades then holds the scene's bounding
/// box as seen from each of its cameras (of a scene that moves, at 0 s) and is not far too large for it; else the edge with which it just holds the box.
double fitting_cascade_size(const Scene& scene, int count, double size);

/// Whether some triangle may lie in the coarsest of such cascades about `eye`: none does, and there is no indirect light.
bool cascades_meet(const Scene& scene, const glm::vec3& eye, int count, double size, int cells);

}  // namespace clpv
