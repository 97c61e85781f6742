// SPDX-License-Identifier: MIT
// Transmittance of the links into a cell from the blockers at its corners.
//
//   T = 1 - clamp(B, 0, 1)
//   B = sum_a |w_a| B_a           areas
//   B = sum_i c_i b_i(-w)         one-sided
//
// B is the blocking potential along the link, B_a or c_i a mean over the corners of the face, edge
// or corner that it passes. A sweep has links from 26 neighbours, steps have 30: six neighbours
// with five faces each. docs/method.md, 'Blockers'.
//
// From the host (host/pipeline/steps/transmittance.cpp): CLPV_LINKS, and for each link
// CLPV_LINK_SIDES, the side of the cell that it passes (-1, 0 or 1 along each axis), and
// CLPV_LINK_BLOCKED, the weights of the blockers' numbers, divided by the number of corners.
#pragma once

#include "volume/geometry.h"
#include "volume/links.h"

__constant const int link_sides[3 * CLPV_LINKS] = CLPV_LINK_SIDES;
__constant const float link_blocked[CLPV_LINKS][CLPV_N] = CLPV_LINK_BLOCKED;

// The lower or the upper one of two corners along an axis, or the sum of both.
CLPV_INLINE realW pick_side(const int side, const realW lower, const realW upper) {
  return side < 0 ? lower : (side > 0 ? upper : lower + upper);
}

// Sum of number i of the blockers over the corners that a link passes. Corner bits: 1 x, 2 y, 4 z.
CLPV_INLINE realW sum_corners(const Coefficients* corners, const int link, const int i) {
  realW edges[4];
#pragma unroll
  for (int e = 0; e < 4; ++e)
    edges[e] = pick_side(link_sides[3 * link], corners[2 * e].c[i], corners[2 * e + 1].c[i]);
  return pick_side(link_sides[3 * link + 2],
                   pick_side(link_sides[3 * link + 1], edges[0], edges[1]),
                   pick_side(link_sides[3 * link + 1], edges[2], edges[3]));
}

// T of every link into W cells.
CLPV_INLINE Links find_transmittance(CLPV_VOLUME_IN blockers, const int x, const int y,
                                     const int z) {
  Coefficients corners[8];
#pragma unroll
  for (int c = 0; c < 8; ++c) {
    const Coefficients corner =
        geometry_load(blockers, 0, x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
    copy_coefficients(&corner, corners + c);
  }
  Links links;
#pragma unroll
  for (int link = 0; link < CLPV_LINKS; ++link) {
    realW blocked = 0.0f;
#pragma unroll
    for (int i = 0; i < CLPV_N; ++i)
      if (link_blocked[link][i] != 0.0f)
        blocked = fma((realW)(link_blocked[link][i]), sum_corners(corners, link, i), blocked);
    const realW share = blocked > ZERO ? blocked : ZERO;
    links.c[link] = ONE - (share < ONE ? share : ONE);
  }
  return links;
}
