// SPDX-License-Identifier: MIT
// Weights of cascades at W points, and the points in their cells (docs/method.md, 'Gathering').
//
// A cascade has the weight min(1, d CLPV_INVERSE_BLEND), d the distance [cells] of p from the
// boundary of the cube about the eye; a coarser cascade gets the weight that finer ones leave.
// Light is therefore continuous, also when a grid moves by a cell, and 0 outside all cascades.
//
// From the host: CLPV_GRID, CLPV_INVERSE_BLEND.
#pragma once

#include "lanes.h"
#include "shared/grid.h"
#include "vec.h"

// Clamps to [0, maximum]; NaN becomes 0.
CLPV_INLINE realW clamp_to(const realW v, const float maximum) {
  const realW upper = (realW)(maximum);
  return v > ZERO ? (v < upper ? v : upper) : ZERO;
}

// Share of a cascade in the weight that finer ones leave, in [0, 1].
CLPV_INLINE realW cascade_share(const ClpvGrid grid, const Vec position) {
  const Vec from_eye = vec_minus(position, vec_of(grid.middle));
  const realW x = fabs(from_eye.x), y = fabs(from_eye.y), z = fabs(from_eye.z), xy = x > y ? x : y;
  const realW farthest = xy > z ? xy : z;
  const realW inside = (float)grid_reach(CLPV_GRID) - farthest * (1.0f / grid.cell);
  return clamp_to(inside * CLPV_INVERSE_BLEND, 1.0f);
}

// The points position + offset * s * lift [m] in a cascade, s its cell, in cells from the first
// centre.
CLPV_INLINE Vec find_cascade_points(const ClpvGrid grid, const Vec position, const realW offset,
                                    const Vec lift) {
  const Vec at = vec_times(vec_minus(position, vec_of(grid.origin)), (realW)(1.0f / grid.cell));
  const Vec lifted = vec_add_scaled(at, offset, lift);
  return vec(lifted.x - 0.5f, lifted.y - 0.5f, lifted.z - 0.5f);
}
