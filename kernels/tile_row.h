// SPDX-License-Identifier: MIT
// Eight pixels of a view that a work-item resolves, and the depths behind them.
#ifndef CLPV_TILE_ROW_H
#define CLPV_TILE_ROW_H

#include "lanes.h"
#include "shared/raster.h"
#include "surface.h"
#include "vec.h"

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
  p.count = tile < tiles && p.py < view.height ? min(view.width - p.px, (uint)CLPV_ABREAST) : 0;
  p.row = (p.py / CLPV_TILE * tiles + tile) * CLPV_TILE + p.py % CLPV_TILE;
  p.x = (float)p.px + (float8)(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f);
  p.y = (float8)((float)p.py);
  return p;
}

// The depth of the surface hit, which may lie before the near depth; unset where there is none.
static inline float8 hit_depth(const ClpvView view, const float8 key) {
  return CLPV_PARALLEL(view) ? key : -1.0f / key;
}

// What is kept of it; 0 where there is none.
static inline float8 stored_depth(const ClpvView view, const float8 key) {
  const float8 depth = hit_depth(view, key), near = (float8)(view.near_depth);
  return key == (float8)(INFINITY) ? (float8)(0.0f) : depth > near ? depth : near;
}

static inline void store_depth(const ClpvView view, const Eight p, const float8 key, __global float* depths) {
  float stored[CLPV_ABREAST];
  vstore8(stored_depth(view, key), 0, stored);
  for (uint i = 0; i < p.count; ++i) depths[p.py * view.width + p.px + i] = stored[i];
}

// 0 where nothing is seen.
static inline Vec seen_alone(const int8 hit, const Vec v) {
  const float8 none = (float8)(0.0f);
  return vec(hit ? v.x : none, hit ? v.y : none, hit ? v.z : none);
}

// Lane by lane: a vector, or 0 where nothing is seen.
typedef struct {
  float x[CLPV_ABREAST], y[CLPV_ABREAST], z[CLPV_ABREAST];
} Unpacked;

static inline Unpacked unpack(const int8 hit, const Vec v) {
  const Vec seen = seen_alone(hit, v);
  Unpacked lanes;
  vstore8(seen.x, 0, lanes.x);
  vstore8(seen.y, 0, lanes.y);
  vstore8(seen.z, 0, lanes.z);
  return lanes;
}

#endif
