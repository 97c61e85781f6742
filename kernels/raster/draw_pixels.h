// SPDX-License-Identifier: MIT
// With one lane: a work-group draws the triangles of a tile, an item a pixel. Its items load as
// many entries at once into local memory, set up their edges once, and leave out those that miss
// the tile or lie behind it: the chain of an item is the entries that remain, and short steps.
#pragma once

#include "raster/alpha_mask.h"
#include "raster/tile_edges.h"
#include "raster/tile_row.h"
#include "raster/triangle.h"
#include "shared/loops.h"

enum { CLPV_ROWS = 1, CLPV_TILE_PIXELS = CLPV_TILE * CLPV_TILE };

// A triangle that may cover a pixel of the tile.
typedef struct {
  int e0, e1, e2;           // edge functions at the tile's first pixel (Edges)
  int dx0, dx1, dx2;        // their change to the pixel below
  int dy0, dy1, dy2;        // minus their change to the pixel on the right
  float key, key_x, key_y;  // as in ClpvRasterTriangle
  float nearest, farthest;
  uint first, last, triangle;
  float smallest;  // key of the entry
  uint index;      // in the list
} Candidate;

// Data that a work-group shares.
typedef struct {
  __local Candidate* candidates;  // CLPV_TILE_PIXELS
  __local uint* count;            // number of candidates
  __local float* keys;            // CLPV_TILE_PIXELS
  __local float* row_keys;        // CLPV_TILE
} Shared;

// A pixel while its tile is drawn.
typedef struct {
  float key;
  uint seen;
  int x, y, column, row;  // in the view, and in the tile
  float far_key;
  bool only_depth;
} Pixel;

// Largest key of the tile's pixels. Sets the count of candidates to 0.
static inline float farthest_of_tile(const Shared shared, const float key) {
  const uint item = get_local_id(1) * CLPV_TILE + get_local_id(0);
  shared.keys[item] = key;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < CLPV_TILE) {
    float largest = shared.keys[item];
    for (uint i = item; i < CLPV_TILE_PIXELS; i += CLPV_TILE)
      largest = fmax(largest, shared.keys[i]);
    shared.row_keys[item] = largest;
  }
  if (item == 0) *shared.count = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  float largest = shared.row_keys[0];
  for (uint i = 1; i < CLPV_TILE; ++i) largest = fmax(largest, shared.row_keys[i]);
  return largest;
}

static inline int largest_edge(const int at, const int dx, const int dy) {
  return at + (CLPV_TILE - 1) * (max(dx, 0) + max(-dy, 0));
}

// Adds triangle `index` of the list to the candidates if it may cover a pixel of the tile.
static inline void add_candidate(const Shared shared, const int tile_x, const int tile_y,
                                 __global const ClpvRasterTriangle* list, const uint index,
                                 const float smallest) {
  __global const ClpvRasterTriangle* r = list + index;
  Edges edges;
  edges_at(r, tile_x, tile_y, &edges);
  const int4 y = vload4(0, r->y);
  const int dy0 = y.y - y.x, dy1 = y.z - y.y, dy2 = y.w - y.z;
  const uint kind = r->triangle;
  const bool misses = (largest_edge(edges.e0, edges.step0, dy0) |
                       largest_edge(edges.e1, edges.step1, dy1) |
                       largest_edge(edges.e2, edges.step2, dy2)) < 0;
  // Edge functions of giants do not fit.
  if (misses && (kind & CLPV_TRIANGLE_GIANT) == 0) return;
  const Candidate c = {edges.e0, edges.e1, edges.e2, edges.step0, edges.step1, edges.step2, dy0,
                       dy1, dy2, r->key, r->key_x, r->key_y, r->nearest, r->farthest, r->first,
                       r->last, kind, smallest, index};
  shared.candidates[atomic_inc(shared.count)] = c;
}

static inline void draw_candidate(const ClpvView view, Pixel* pixel, __local const Candidate* c,
                                  __global const ClpvRasterTriangle* list, const Scene scene) {
  if (c->smallest > pixel->key) return;
  const int first_x = (int)(c->first & 0xffffu), first_y = (int)(c->first >> 16);
  if (pixel->y < first_y || pixel->y > (int)(c->last >> 16)) return;
  const uint triangle = c->triangle & CLPV_TRIANGLE_INDEX;
  int closer = ((c->e0 - c->dy0 * pixel->column + c->dx0 * pixel->row) |
                (c->e1 - c->dy1 * pixel->column + c->dx1 * pixel->row) |
                (c->e2 - c->dy2 * pixel->column + c->dx2 * pixel->row)) >= 0;
  if (c->triangle & CLPV_TRIANGLE_GIANT)
    closer = covered_by_giant(list + c->index, pixel->x, pixel->y);
  const float key_left = c->key + c->key_x * (float)(pixel->x - first_x);
  float key = key_left + c->key_y * (float)(pixel->y - first_y);
  key = key > c->nearest ? key : c->nearest;
  key = key < c->farthest ? key : c->farthest;
  closer &= key <= pixel->far_key;
  // In shadow maps, an equal key stays.
  closer &= key < pixel->key || (key == pixel->key && !pixel->only_depth && triangle < pixel->seen);
  if (closer && (c->triangle & CLPV_TRIANGLE_MASKED)) {
    Mask mask;
    load_mask(view, triangle, scene, &mask);
    closer &= solid(view, &mask, (float)pixel->x, (float)pixel->y, hit_depth(view, key),
                    scene.texels);
  }
  pixel->key = closer ? key : pixel->key;
  pixel->seen = closer ? triangle : pixel->seen;
}

// Draws the entries binned[first] to binned[end - 1]; if not `sorted`, triangles first to end - 1
// of the list. Every item of a work-group calls it with the same arguments, but for the pixel.
CLPV_INLINE void draw_entries(const ClpvView view, const Shared shared, Pixel* pixel,
                              __global const ClpvRasterTriangle* list, __global const uint2* binned,
                              const bool sorted, uint first, const uint end, const Scene scene) {
  const uint item = pixel->row * CLPV_TILE + pixel->column;
  const int tile_x = pixel->x - pixel->column, tile_y = pixel->y - pixel->row;
  while (first < end) {
    const uint stop = min(end - first, CLPV_LONGEST_LOOP) + first;
    for (; first < stop; first += CLPV_TILE_PIXELS) {
      const float farthest = farthest_of_tile(shared, pixel->key);
      const uint i = first + item;
      if (i < stop) {
        const uint2 entry = sorted ? binned[i] : (uint2)(i, as_uint(list[i].nearest));
        if (as_float(entry.y) <= farthest)
          add_candidate(shared, tile_x, tile_y, list, entry.x, as_float(entry.y));
      }
      barrier(CLK_LOCAL_MEM_FENCE);
      const uint count = *shared.count;
      for (uint k = 0; k < count; ++k)
        draw_candidate(view, pixel, shared.candidates + k, list, scene);
    }
    first = stop;
  }
}
