// SPDX-License-Identifier: MIT
// Exact coverage of pixels by a triangle: edge functions in 64-bit integers, with the top-left
// rule.
#pragma once

#include "shared/raster.h"

// Edge function from corner i to the next: not negative at pixel centres on the inner side. Centres
// on the edge itself are inside if it is a top or a left edge, so that they belong to one of the
// two triangles that share it.
typedef struct {
  long value;           // at the centre of a pixel
  long step_x, step_y;  // change to the pixel on the right, and below
} Edge;

// Edge function from corner (x0, y0) to (x1, y1) at pixel (px, py). Corners in 1/CLPV_SUBPIXELS
// pixel.
static inline Edge edge_between(const int x0, const int y0, const int x1, const int y1,
                                const int px, const int py) {
  const int dx = x1 - x0, dy = y1 - y0;
  const int x = px * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2,
            y = py * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2;
  const bool top_left = dy < 0 || (dy == 0 && dx > 0);
  Edge edge;
  edge.value = (long)dx * (y - y0) - (long)dy * (x - x0) - (top_left ? 0 : 1);
  edge.step_x = -(long)dy * CLPV_SUBPIXELS;
  edge.step_y = (long)dx * CLPV_SUBPIXELS;
  return edge;
}

static inline Edge edge_at(__global const ClpvRasterTriangle* r, const int i, const int px,
                           const int py) {
  return edge_between(r->x[i], r->y[i], r->x[i + 1], r->y[i + 1], px, py);
}

// Maximum of an edge function over a tile. `edge`: at the tile's upper left pixel.
static inline long largest_in_tile(const Edge edge) {
  return edge.value + (CLPV_TILE - 1) * (max(edge.step_x, 0L) + max(edge.step_y, 0L));
}
