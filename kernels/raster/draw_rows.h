// SPDX-License-Identifier: MIT
// With eight lanes: a work-item draws the triangles of a tile, in rows of eight pixels.
#pragma once

#include "prefetch.h"
#include "raster/alpha_mask.h"
#include "raster/tile_edges.h"
#include "raster/tile_row.h"
#include "raster/triangle.h"
#include "shared/loops.h"

enum { CLPV_ROWS = CLPV_TILE };  // rows of a tile that a work-item draws

// A work-item's part of a tile while it draws.
typedef struct {
  realW* keys;
  uintW* seen;
  int x, y;  // first pixel
  float far_key;
  bool only_depth;
} Tile;

// Draws a triangle into a tile. `kind`: flags of ClpvRasterTriangle; `mask`: room for the mask of a
// masked material; unused for others. `only_depth`: as in the tile, a literal where time counts.
CLPV_INLINE void draw(const ClpvView view, const Tile tile, __global const ClpvRasterTriangle* r,
                      const uint kind, const bool masked, Mask* mask, const bool only_depth,
                      const Scene scene) {
  const realW column = to_realW(lane_numbers());
  const uint triangle = kind & CLPV_TRIANGLE_INDEX;
  const int first_x = (int)(r->first & 0xffffu), first_y = (int)(r->first >> 16);
  const int top = max(first_y - tile.y, 0),
            bottom = min((int)(r->last >> 16) - tile.y, CLPV_ROWS - 1);
  bool loaded = false;  // the mask is
  Edges edges;
  edges_at(r, tile.x, tile.y + top, &edges);
  const realW key_left = r->key + r->key_x * (column + (float)(tile.x - first_x));
  const realW nearest = (realW)(r->nearest), farthest = (realW)(r->farthest);
  const float key_y = r->key_y;
  for (int row = top; row <= bottom; ++row) {
    intW closer = (edges.e0 | edges.e1 | edges.e2) >= 0;
    edges.e0 += edges.step0, edges.e1 += edges.step1, edges.e2 += edges.step2;
    if (kind & CLPV_TRIANGLE_GIANT) closer = covered_by_giant(r, tile.x, tile.y + row);
    realW key = key_left + key_y * (float)(tile.y + row - first_y);
    key = key > nearest ? key : nearest;
    key = key < farthest ? key : farthest;
    const realW old = tile.keys[row];
    const uintW old_seen = only_depth ? (uintW)(0u) : tile.seen[row];  // 0: an equal key stays
    closer &= (key <= tile.far_key) & ((key < old) | ((key == old) & (triangle < old_seen)));
    if (masked) {
      if (no_lane(closer)) continue;
      if (!loaded) load_mask(view, triangle, scene, mask);
      loaded = true;
      const realW depth = hit_depth(view, key);
      closer &= solid(view, mask, (float)tile.x, (float)(tile.y + row), depth, scene.texels);
    }
    tile.keys[row] = select(old, key, closer);
    if (!only_depth) tile.seen[row] = select(old_seen, (uintW)(triangle), closer);
  }
}

CLPV_OUT_OF_LINE_ON_CPUS
void draw_masked(const ClpvView view, const Tile tile,
                 __global const ClpvRasterTriangle* r, const uint kind,
                 const Scene scene) {
  Mask mask;
  draw(view, tile, r, kind, true, &mask, tile.only_depth, scene);
}

// Largest key of the pixels.
static inline float farthest_of(const realW* keys) {
  realW largest = keys[0];
  for (int row = 1; row < CLPV_ROWS; ++row) {
    const realW key = keys[row];
    largest = key > largest ? key : largest;
  }
  return -min_lane(-largest);
}

CLPV_INLINE void draw_listed(const ClpvView view, const Tile tile,
                             __global const ClpvRasterTriangle* r, const Scene scene) {
  const uint kind = r->triangle;
  if (kind & CLPV_TRIANGLE_MASKED) {
    draw_masked(view, tile, r, kind, scene);
  } else if (tile.only_depth) {
    draw(view, tile, r, kind, false, 0, true, scene);
  } else {
    draw(view, tile, r, kind, false, 0, false, scene);
  }
}

// Draws the `count` triangles of the list whose boxes overlap the tile.
CLPV_OUT_OF_LINE_ON_CPUS
void draw_whole_list(const ClpvView view, const Tile tile,
                     __global const ClpvRasterTriangle* list, const uint count,
                     const Scene scene) {
  const int right = tile.x + W - 1, bottom = tile.y + CLPV_ROWS - 1;
  for (uint first = 0; first < count; first += CLPV_LONGEST_LOOP) {
    const uint stop = min(count - first, CLPV_LONGEST_LOOP) + first;
    for (uint i = first; i < stop; ++i) {
      __global const ClpvRasterTriangle* r = list + i;
      const bool left_of =
          (int)(r->last & 0xffffu)<tile.x, right_of = (int)(r->first & 0xffffu)> right;
      const bool above = (int)(r->last >> 16) < tile.y, below = (int)(r->first >> 16) > bottom;
      if (!(left_of || right_of || above || below)) draw_listed(view, tile, r, scene);
    }
  }
}

// Triangles of a tile are scattered over the list: prefetch the one that is drawn this many later.
#define CLPV_DRAW_AHEAD 2

// Draws the entries binned[first] to binned[end - 1].
CLPV_INLINE void draw_binned(const ClpvView view, const Tile tile,
                             __global const ClpvRasterTriangle* list, __global const uint2* binned,
                             uint first, const uint end, const Scene scene) {
  float farthest = farthest_of(tile.keys);  // triangles behind it are hidden
  for (; first < end; first += CLPV_LONGEST_LOOP) {
    const uint stop = min(end - first, CLPV_LONGEST_LOOP) + first;
    for (uint i = first; i < stop; ++i) {
      if (as_float(binned[i].y) > farthest) continue;
      __global const ClpvRasterTriangle* r = list + binned[i].x;
      prefetch_line(list + binned[min(i + CLPV_DRAW_AHEAD, stop - 1)].x);
      draw_listed(view, tile, r, scene);
      farthest = farthest_of(tile.keys);
    }
  }
}
