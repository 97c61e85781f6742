// SPDX-License-Identifier: MIT
// Light that a cell's surfaces send back, by direction bin (docs/method.md, 'More bounces'). In double; knows no OpenCL.
#pragma once

#include "basis/matrix.hpp"

namespace clpv {

/// Surfaces of a cell are known by which way along the axes they face: +x, -x, +y, -y, +z, -z.
inline constexpr int kReflectingSides = 6;

/// Of light that bounces on, after the third bounce: what is left then is next to nothing but in a closed white room.
inline constexpr int kFurtherBounces = 6;

/// 6 x 24: the flux [W] that falls on a whole face of a cell, from what a sweep leaves in its bins (radiance times s^2).
/// It is the flux that a sweep along 24 directions carries from plane to plane.
Matrix arriving_flux();

/// 24 x 6: a sweep's light [W/sr] in each bin, from flux [W] that leaves a side by the cosine. All of it leaves.
Matrix leaving_light();

/// Where two sides of a cell meet at an edge, a sweep takes light that leaves through it once, and arriving_flux() counts
/// it on both: of even light on two whole sides, so much of either's.
double edge_loss();

}  // namespace clpv
