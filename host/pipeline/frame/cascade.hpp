// SPDX-License-Identifier: MIT
// Positions of the cascade grids: nested around the camera and snapped to whole cells.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/grid.h"
#include "scene/scene.hpp"

namespace clpv {

/// Returns `count` grids of `cells`^3 cells, finest first, with edges `size`, 2 size, 4 size ...
/// [m]. Each is centred at `eye` [m] and snapped to whole cells. Camera motion inside a cell moves
/// no grid, so light does not flicker (Kaplanyan & Dachsbacher 2010, section 5). Throws
/// Error(usage) that names `cascade-size` if float coordinates at `eye` are too coarse for the
/// cells.
std::vector<ClpvGrid> cascade_grids(const glm::vec3& eye, int count, double size, int cells);

/// Returns true if light at `position` [m] may come from the cascade, the coarsest one of a frame.
bool reaches(const ClpvGrid& grid, const glm::dvec3& position);

/// Returns true if triangles may lie in the coarsest cascade around `eye`. If false, there is no
/// indirect light.
bool cascades_meet(const SceneData& scene, const glm::vec3& eye, int count, double size, int cells);

}  // namespace clpv
