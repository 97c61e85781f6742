// SPDX-License-Identifier: MIT
// Row of eight pixels that a work-item processes, and conversion of depth keys.
#ifndef CLPV_TILE_ROW_H
#define CLPV_TILE_ROW_H

#include "lanes.h"
#include "shared/raster.h"
#include "raster/surface.h"
#include "vec.h"

// Eight pixels of a row of a view.
typedef struct {
  uint px, py;  // first pixel
  uint count;   // number of pixels inside the view
  uint row;     // index in the buffers of draw_tiles.cl
  float8 x, y;  // px + lane, py
} PixelRow;

static inline PixelRow this_row(const ClpvView view) {
  PixelRow p;
  const uint tile = get_global_id(0), tiles = (view.width + CLPV_TILE - 1) / CLPV_TILE;
  p.px = tile * CLPV_TILE;
  p.py = get_global_id(1);
  p.count = tile < tiles && p.py < view.height ? min(view.width - p.px, (uint)CLPV_ABREAST) : 0;
  p.row = (p.py / CLPV_TILE * tiles + tile) * CLPV_TILE + p.py % CLPV_TILE;
  p.x = (float)p.px + (float8)(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f);
  p.y = (float8)((float)p.py);
  return p;
}

// Depth [m] of the surface with a key; may be less than the near depth. Undefined for empty pixels.
static inline float8 hit_depth(const ClpvView view, const float8 key) {
  return CLPV_PARALLEL(view) ? key : -1.0f / key;
}

// Depth [m] that is stored: at least the near depth; 0 for empty pixels.
static inline float8 stored_depth(const ClpvView view, const float8 key) {
  const float8 depth = hit_depth(view, key), near = (float8)(view.near_depth);
  return key == (float8)(INFINITY) ? (float8)(0.0f) : depth > near ? depth : near;
}

static inline void store_depth(const ClpvView view, const PixelRow p, const float8 key, __global float* depths) {
  float stored[CLPV_ABREAST];
  vstore8(stored_depth(view, key), 0, stored);
  for (uint i = 0; i < p.count; ++i) depths[p.py * view.width + p.px + i] = stored[i];
}

// 0 in lanes outside the mask `hit`.
static inline Vec vec_masked(const int8 hit, const Vec v) {
  const float8 none = (float8)(0.0f);
  return vec(hit ? v.x : none, hit ? v.y : none, hit ? v.z : none);
}

// Vectors as arrays of lanes.
typedef struct {
  float x[CLPV_ABREAST], y[CLPV_ABREAST], z[CLPV_ABREAST];
} VecLanes;

static inline VecLanes unpack(const int8 hit, const Vec v) {
  const Vec masked = vec_masked(hit, v);
  VecLanes lanes;
  vstore8(masked.x, 0, lanes.x);
  vstore8(masked.y, 0, lanes.y);
  vstore8(masked.z, 0, lanes.z);
  return lanes;
}

#endif
