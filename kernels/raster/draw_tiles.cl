// SPDX-License-Identifier: MIT
// Finds the nearest triangle of each pixel: depth test of the triangles that rasterize.cl listed
// for a tile.
//
//   inside: no edge function e_i(x, y) is negative
//   key(x, y) = key + x key_x + y key_y, smaller is nearer
//
// Tiled rasterisation with integer edge functions (Pineda 1988, 'A parallel algorithm for polygon
// rasterization'; docs/method.md, 'Rasterize'). A pixel keeps the smallest key, and of equal keys
// the smallest triangle number: results do not depend on the order of the lists.
//
// In:      list          ClpvRasterTriangle of the view
//          starts        index in `binned` of the first entry of each slice of each tile
//          binned        entries: index in `list`, smallest key
//          counts        CLPV_LISTED and so on. With more entries than most_entered, `starts` and
//                        `binned` are incomplete: every tile then draws the whole list, slowly
//          fresh         1: tiles start empty; 0: they continue from `keys` and `seen`
//          only_depth    1: a shadow map, which needs no `seen`
//          vertices, triangles, materials, textures, texels   the scene, for masked materials
// In, out: keys, seen    key, and number in the scene, of the nearest triangle: CLPV_TILE numbers
//                        per row of a tile, CLPV_TILE rows per tile, tiles row by row; INFINITY and
//                        UINT_MAX for empty pixels
// Out:     farthest      largest key of the pixels of each tile
// With W 8 a work-item draws a tile, with W 1 a pixel: a work-group has a tile.
#include "lanes.h"
#include "prefetch.h"
#include "raster/alpha_mask.h"
#include "raster/tile_edges.h"
#include "raster/tile_row.h"
#include "raster/triangle.h"
#include "shared/loops.h"

// Rows of a tile that a work-item draws.
#if W == 1
#define CLPV_ROWS 1
#else
#define CLPV_ROWS CLPV_TILE
#endif

// A work-item's part of a tile while it draws.
typedef struct {
  realW* keys;
  uintW* seen;
  int x, y;  // first pixel
  float far_key;
  bool only_depth;
} Tile;

// Draws a triangle into a tile. `kind`: flags of ClpvRasterTriangle; `mask`: room for the mask of a
// masked material; unused for others. `only_depth`: that of the tile, a literal where time counts.
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
    const int at = CLPV_ROWS == 1 ? 0 : row;
    intW closer = (edges.e0 | edges.e1 | edges.e2) >= 0;
    edges.e0 += edges.step0, edges.e1 += edges.step1, edges.e2 += edges.step2;
    if (kind & CLPV_TRIANGLE_GIANT) closer = covered_by_giant(r, tile.x, tile.y + row);
    realW key = key_left + key_y * (float)(tile.y + row - first_y);
    key = key > nearest ? key : nearest;
    key = key < farthest ? key : farthest;
    const realW old = tile.keys[at];
    const uintW old_seen = only_depth ? (uintW)(0u) : tile.seen[at];  // 0: an equal key stays
    closer &= (key <= tile.far_key) & ((key < old) | ((key == old) & (triangle < old_seen)));
    if (masked) {
      if (no_lane(closer)) continue;
      if (!loaded) load_mask(view, triangle, scene, mask);
      loaded = true;
      const realW depth = hit_depth(view, key);
      closer &= solid(view, mask, (float)tile.x, (float)(tile.y + row), depth, scene.texels);
    }
    tile.keys[at] = select(old, key, closer);
    if (!only_depth) tile.seen[at] = select(old_seen, (uintW)(triangle), closer);
  }
}

CLPV_RARE void draw_masked(const ClpvView view, const Tile tile,
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
CLPV_RARE void draw_whole_list(const ClpvView view, const Tile tile,
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

#if W == 1
__attribute__((reqd_work_group_size(CLPV_TILE, CLPV_TILE, 1)))
#endif
__kernel void draw_tiles(const ClpvView view, const uint fresh, const uint only_depth,
                         __global const ClpvRasterTriangle* list, __global const uint* starts,
                         __global const uint2* binned, __global const uint* counts,
                         const uint most_entered, __global const ClpvVertex* vertices,
                         __global const ClpvTriangle* triangles,
                         __global const ClpvMaterial* materials, __global const float4* textures,
                         __global const uint* texels, __global realW* keys, __global uintW* seen,
                         __global float* farthest) {
  const uint tiles_x = (view.width + CLPV_TILE - 1) / CLPV_TILE,
             x = get_global_id(0) / CLPV_TILE_VECTORS, y = get_global_id(1) * CLPV_ROWS / CLPV_TILE,
             vector = get_global_id(0) % CLPV_TILE_VECTORS,
             first_row = get_global_id(1) * CLPV_ROWS % CLPV_TILE;
  if (x >= tiles_x || y * CLPV_TILE >= view.height) return;
  const uint at = y * tiles_x + x;
  const bool sorted = counts[CLPV_ENTERED] <= most_entered && counts[CLPV_ENTERED_TOO_MANY] == 0;
  const uint start = starts[at * CLPV_SLICES], end = starts[(at + 1) * CLPV_SLICES];
  if (!fresh && sorted && start == end) return;
  const Scene scene = {vertices, triangles, materials, textures, texels};
  realW near_keys[CLPV_ROWS];
  uintW nearest[CLPV_ROWS];
  const Tile tile = {near_keys, nearest, (int)(x * CLPV_TILE + vector * W),
                     (int)(y * CLPV_TILE + first_row),
                     is_orthographic(view) ? view.far_depth : -1.0f / view.far_depth,
                     only_depth != 0};
  for (int row = 0; row < CLPV_ROWS; ++row) {
    const uint from = tile_row(at, first_row + row, vector);
    near_keys[row] = fresh ? (realW)(INFINITY) : keys[from];
    if (only_depth) continue;
    nearest[row] = fresh ? (uintW)(UINT_MAX) : seen[from];
  }
  if (sorted) {
    draw_binned(view, tile, list, binned, start, end, scene);
  } else {
    draw_whole_list(view, tile, list, counts[CLPV_LISTED], scene);
  }
  for (int row = 0; row < CLPV_ROWS; ++row) {
    const uint to = tile_row(at, first_row + row, vector);
    keys[to] = near_keys[row];
    if (!only_depth) seen[to] = nearest[row];
  }
#if W == 1
  __local float of_pixels[CLPV_TILE * CLPV_TILE];
  const uint pixel = first_row * CLPV_TILE + vector;
  of_pixels[pixel] = near_keys[0];
  barrier(CLK_LOCAL_MEM_FENCE);
  if (pixel != 0) return;
  float largest = of_pixels[0];
  for (int i = 1; i < CLPV_TILE * CLPV_TILE; ++i) largest = fmax(largest, of_pixels[i]);
  farthest[at] = largest;
#else
  farthest[at] = farthest_of(near_keys);
#endif
}

// Returns true if some tile of a cluster has pixels behind its nearest key.
static inline bool may_be_seen(const ClpvView view, const ClpvViewCluster cluster,
                               __global const float* farthest) {
  const uint tiles_x = (view.width + CLPV_TILE - 1) / CLPV_TILE;
  const uint left = cluster.first & 0xffffu, right = cluster.last & 0xffffu;
  for (uint y = cluster.first >> 16; y <= cluster.last >> 16; ++y) {
    for (uint at = y * tiles_x + left; at <= y * tiles_x + right; ++at) {
      if (!(farthest[at] < cluster.nearest)) return true;
    }
  }
  return false;
}

// Marks those of `count` clusters from `first` on whose triangles lie behind all that draw_tiles
// has drawn.
__kernel void hide_clusters(const ClpvView view, const uint first, const uint count,
                            __global const float* farthest, __global ClpvViewCluster* clusters) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const ClpvViewCluster cluster = clusters[first + i];
  if (!may_be_seen(view, cluster, farthest)) clusters[first + i].number = CLPV_HIDDEN;
}

// Only depths: a shadow map. A work-item stores W pixels of a row.
__kernel void resolve_depth(const ClpvView view, __global const realW* keys,
                            __global float* depths) {
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  store_depth(view, p, keys[p.row], depths);
}
