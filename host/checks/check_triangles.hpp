// SPDX-License-Identifier: MIT
// What the checks of the stages that go through a scene's triangles share.
#pragma once

#include "scene/scene.hpp"

namespace clpv::reference {

/// Triangles in and round a grid of nine cells of half a metre from (-2.5, 0.5, 1) on: specks, some of some cells, others
/// far larger than the grid, one without area, some along an axis, and a third of them with holes.
Scene triangle_soup();

}  // namespace clpv::reference
