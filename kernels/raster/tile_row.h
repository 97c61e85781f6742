// SPDX-License-Identifier: MIT
// Row of W pixels that a work-item processes, and conversion of depth keys.
#pragma once

#include "lanes.h"
#include "shared/raster.h"
#include "raster/surface.h"
#include "vec.h"

// W pixels of a row of a view, within one tile.
typedef struct {
  uint px, py;  // first pixel
  uint count;   // number of pixels inside the view
  uint row;     // index in the buffers of draw_tiles.cl, in vectors
  realW x, y;  // px + lane, py
} PixelRow;

// Vectors of W pixels in a row of a tile; tile_row(): index of such a vector in `keys` and `seen`
// of draw_tiles.cl.
enum { CLPV_TILE_VECTORS = CLPV_TILE / W };
static inline uint tile_row(const uint tile, const uint row, const uint vector) {
  return (tile * CLPV_TILE + row) * CLPV_TILE_VECTORS + vector;
}

// Tiles of a view along x, and all of them.
static inline uint tiles_across(const ClpvView view) {
  return (view.width + CLPV_TILE - 1) / CLPV_TILE;
}
static inline uint tiles_in(const ClpvView view) {
  return tiles_across(view) * ((view.height + CLPV_TILE - 1) / CLPV_TILE);
}

// With several views of one size, the third id of the work-group is the number of the view: unlike
// that of an item, compilers know it to be the same for the group.
static inline PixelRow find_pixel_row(const ClpvView view) {
  PixelRow p;
  const uint column = get_global_id(0), first_tile = get_group_id(2) * tiles_in(view);
  p.px = column * W;
  p.py = get_global_id(1);
  p.count = p.px < view.width && p.py < view.height ? min(view.width - p.px, (uint)W) : 0;
  p.row = tile_row(first_tile + p.py / CLPV_TILE * tiles_across(view) + column / CLPV_TILE_VECTORS,
                   p.py % CLPV_TILE, column % CLPV_TILE_VECTORS);
  p.x = (float)p.px + to_realW(lane_numbers());
  p.y = (realW)((float)p.py);
  return p;
}

// Zeroes the counters of rasterize.cl for its next launch, in place of two fills: all work-items of
// a kernel that no longer reads them do so.
static inline void clear_counters(const uint slices, __global uint* counts,
                                  __global uint* slice_counts) {
  const uint row = get_global_id(2) * get_global_size(1) + get_global_id(1),
             item = row * get_global_size(0) + get_global_id(0),
             items = get_global_size(0) * get_global_size(1) * get_global_size(2);
  for (uint i = item; i <= slices; i += items) slice_counts[i] = 0;
  if (item < CLPV_RASTER_COUNTERS) counts[item] = 0;
}

// Depth [m] of the surface with a key; may be less than the near depth. Undefined for empty pixels.
static inline realW hit_depth(const ClpvView view, const realW key) {
  return is_orthographic(view) ? key : -1.0f / key;
}

// Depth [m] that is stored: at least the near depth; 0 for empty pixels.
static inline realW stored_depth(const ClpvView view, const realW key) {
  const realW depth = hit_depth(view, key), near = (realW)(view.near_depth);
  return key == (realW)(INFINITY) ? ZERO : depth > near ? depth : near;
}

static inline void store_depth(const ClpvView view, const PixelRow p, const realW key,
                               __global float* depths) {
  const realW depth = stored_depth(view, key);
  if (W > 1 && p.count == W) {
    store_lanes(depth, depths + p.py * view.width + p.px);
    return;
  }
  float stored[W];
  store_lanes(depth, stored);
  for (uint i = 0; i < p.count; ++i) depths[p.py * view.width + p.px + i] = stored[i];
}

// 0 in lanes outside the mask `hit`.
static inline Vec vec_masked(const intW hit, const Vec v) {
  return vec(hit ? v.x : ZERO, hit ? v.y : ZERO, hit ? v.z : ZERO);
}

// Vectors as arrays of lanes.
typedef struct {
  float x[W], y[W], z[W];
} VecLanes;

static inline VecLanes unpack(const intW hit, const Vec v) {
  const Vec masked = vec_masked(hit, v);
  VecLanes lanes;
  store_lanes(masked.x, lanes.x);
  store_lanes(masked.y, lanes.y);
  store_lanes(masked.z, lanes.z);
  return lanes;
}
