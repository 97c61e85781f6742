// SPDX-License-Identifier: MIT
// Edge functions of a triangle at the pixels of a tile, in 32 bits.
#pragma once

#include "lanes.h"
#include "raster/edges.h"

// Edge functions of a triangle in a tile, divided by 256: a centre is inside where none is
// negative. The sign is exact, since steps are multiples of 256. Values far from 0 keep their sign
// throughout the tile and are clamped to 32 bits.
typedef struct {
  intW e0, e1, e2;          // at W pixels of a row
  int step0, step1, step2;  // change to the row below
} Edges;

#define CLPV_FAR_OUT \
  0x40000000L  // more than 2 x 7 steps of a triangle that is not CLPV_TRIANGLE_GIANT

// Edge functions at the row of W pixels from (px, py) on.
CLPV_INLINE void edges_at(__global const ClpvRasterTriangle* r, const int px, const int py,
                          Edges* edges) {
  const intW lane = lane_numbers();
  const int4 x = vload4(0, r->x), y = vload4(0, r->y);
  const int4 dx = x.yzwx - x, dy = y.yzwx - y;
  const int4 top_left = (dy < 0) | ((dy == 0) & (dx > 0));
  const int4 to_x = px * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2 - x,
             to_y = py * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2 - y;
  const long4 exact = convert_long4(dx) * convert_long4(to_y) -
                      convert_long4(dy) * convert_long4(to_x) - 1L - convert_long4(top_left);
  const int4 at = convert_int4(min(max(exact >> 8, (long4)(-CLPV_FAR_OUT)), (long4)(CLPV_FAR_OUT)));
  edges->e0 = at.x - dy.x * lane, edges->step0 = dx.x;
  edges->e1 = at.y - dy.y * lane, edges->step1 = dx.y;
  edges->e2 = at.z - dy.z * lane, edges->step2 = dx.z;
}

// Mask of the W pixels from (px, py) on that a giant triangle covers. Giants are few.
CLPV_OUT_OF_LINE_ON_CPUS
intW covered_by_giant(__global const ClpvRasterTriangle* r, const int px, const int py) {
  const longW lane = to_longW(lane_numbers());
  const Edge e0 = edge_at(r, 0, px, py), e1 = edge_at(r, 1, px, py), e2 = edge_at(r, 2, px, py);
  const longW v0 = e0.value + lane * e0.step_x, v1 = e1.value + lane * e1.step_x,
              v2 = e2.value + lane * e2.step_x;
  return to_intW((v0 | v1 | v2) >= 0L);
}
