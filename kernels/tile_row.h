// SPDX-License-Identifier: MIT
// Eight pixels of a view that a work-item resolves, and the depths behind them.
#ifndef CLPV_TILE_ROW_H
#define CLPV_TILE_ROW_H

#include "lanes.h"
#include "shared/raster.h"
#include "surface.h"

#ifndef CLPV_ORTHOGRAPHIC
#define CLPV_ORTHOGRAPHIC 0
#endif

// The eight pixels of a work-item.
typedef struct {
  uint px, py;  // of the first
  uint count;   // how many of them the view has; 0: none
  uint row;     // in the buffers of draw_tiles.cl
  float8 x, y;  // px + lane, py
} Eight;

static inline Eight this_row(const ClpvView view) {
  Eight p;
  const uint tile = get_global_id(0), tiles = (view.width + CLPV_TILE - 1) / CLPV_TILE;
  p.px = tile * CLPV_TILE;
  p.py = get_global_id(1);
  p.count = tile < tiles && p.py < view.height ? min(view.width - p.px, (uint)CLPV_LANES) : 0;
  p.row = (p.py / CLPV_TILE * tiles + tile) * CLPV_TILE + p.py % CLPV_TILE;
  p.x = (float)p.px + (float8)(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f);
  p.y = (float8)((float)p.py);
  return p;
}

// The depth of the surface hit, which may lie before the near depth; unset where there is none.
static inline float8 hit_depth(const float8 key) {
  return CLPV_ORTHOGRAPHIC ? key : -1.0f / key;
}

static inline void store_depth(const ClpvView view, const Eight p, const float8 key, __global float* depths) {
  const float8 depth = hit_depth(key), near = (float8)(view.near_depth);
  float stored[CLPV_LANES];
  vstore8(key == (float8)(INFINITY) ? (float8)(0.0f) : depth > near ? depth : near, 0, stored);
  for (uint i = 0; i < p.count; ++i) depths[p.py * view.width + p.px + i] = stored[i];
}

#endif
