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
// In:      views         of one size, drawn together
//          list          ClpvRasterTriangle of the views
//          starts        index in `binned` of the first entry of each slice of each tile
//          binned        entries: index in `list`, smallest key
//          counts        CLPV_LISTED and so on. With more entries than most_entered, `starts` and
//                        `binned` are incomplete: every tile then draws the whole list, slowly
//          clear         1: tiles start empty; 0: they continue from `keys` and `seen`
//          only_depth    1: a shadow map, which needs no `seen`
//          vertices, triangles, materials, textures, texels   the scene, for masked materials
// In, out: keys, seen    key, and number in the scene, of the nearest triangle: CLPV_TILE numbers
//                        per row of a tile, CLPV_TILE rows per tile, tiles row by row, views one
//                        after the other; INFINITY and UINT_MAX for empty pixels
// Out:     farthest      largest key of the pixels of each tile
// With W 8 a work-item draws a tile, with W 1 a pixel: a work-group has a tile.
#include "lanes.h"
#if W == 1
#include "raster/draw_pixels.h"
#else
#include "raster/draw_rows.h"
#endif

#if W == 1
__attribute__((reqd_work_group_size(CLPV_TILE, CLPV_TILE, 1)))
#endif
__kernel void draw_tiles(__constant const ClpvView* views, const uint clear, const uint only_depth,
                         __global const ClpvRasterTriangle* list, __global const uint* starts,
                         __global const uint2* binned, __global const uint* counts,
                         const uint most_entered, __global const ClpvVertex* vertices,
                         __global const ClpvTriangle* triangles,
                         __global const ClpvMaterial* materials, __global const float4* textures,
                         __global const uint* texels, __global realW* keys, __global uintW* seen,
                         __global float* farthest) {
  const ClpvView view = views[get_group_id(2)];
  const uint tiles_x = tiles_across(view),
             x = get_global_id(0) / CLPV_TILE_VECTORS, y = get_global_id(1) * CLPV_ROWS / CLPV_TILE,
             vector = get_global_id(0) % CLPV_TILE_VECTORS,
             first_row = get_global_id(1) * CLPV_ROWS % CLPV_TILE;
  if (x >= tiles_x || y * CLPV_TILE >= view.height) return;
  const uint at = get_group_id(2) * tiles_in(view) + y * tiles_x + x;
  const bool sorted = counts[CLPV_ENTERED] <= most_entered && counts[CLPV_ENTERED_TOO_MANY] == 0;
  const uint start = starts[at * CLPV_SLICES], end = starts[(at + 1) * CLPV_SLICES];
  if (!clear && sorted && start == end) return;
  const Scene scene = {vertices, triangles, materials, textures, texels};
  const float far_key = is_orthographic(view) ? view.far_depth : -1.0f / view.far_depth;
#if W == 1
  __local Candidate candidates[CLPV_TILE_PIXELS];
  __local uint count;
  __local float of_pixels[CLPV_TILE_PIXELS], of_rows[CLPV_TILE];
  const Shared shared = {candidates, &count, of_pixels, of_rows};
  const uint place = tile_row(at, first_row, vector);
  Pixel pixel = {clear ? INFINITY : keys[place],
                 clear || only_depth ? UINT_MAX : seen[place],
                 (int)get_global_id(0),
                 (int)get_global_id(1),
                 (int)vector,
                 (int)first_row,
                 far_key,
                 only_depth != 0};
  draw_entries(view, shared, &pixel, list, binned, sorted, sorted ? start : 0,
               sorted ? end : counts[CLPV_LISTED], scene);
  keys[place] = pixel.key;
  if (!only_depth) seen[place] = pixel.seen;
  barrier(CLK_LOCAL_MEM_FENCE);
  const float largest = farthest_of_tile(shared, pixel.key);
  if (vector + first_row == 0) farthest[at] = largest;
#else
  realW near_keys[CLPV_ROWS];
  uintW nearest[CLPV_ROWS];
  const Tile tile = {near_keys, nearest,         (int)(x * CLPV_TILE), (int)(y * CLPV_TILE),
                     far_key,   only_depth != 0};
  for (int row = 0; row < CLPV_ROWS; ++row) {
    const uint from = tile_row(at, row, 0);
    near_keys[row] = clear ? (realW)(INFINITY) : keys[from];
    if (only_depth) continue;
    nearest[row] = clear ? (uintW)(UINT_MAX) : seen[from];
  }
  if (sorted) {
    draw_binned(view, tile, list, binned, start, end, scene);
  } else {
    draw_whole_list(view, tile, list, counts[CLPV_LISTED], scene);
  }
  for (int row = 0; row < CLPV_ROWS; ++row) {
    const uint to = tile_row(at, row, 0);
    keys[to] = near_keys[row];
    if (!only_depth) seen[to] = nearest[row];
  }
  farthest[at] = farthest_of(near_keys);
#endif
}

// Returns true if some tile of a cluster has pixels behind its nearest key.
static inline bool may_be_seen(const ClpvView view, const ClpvViewCluster cluster,
                               __global const float* farthest) {
  const uint tiles_x = tiles_across(view), first = cluster.view * tiles_in(view);
  const uint left = cluster.first & 0xffffu, right = cluster.last & 0xffffu;
  for (uint y = cluster.first >> 16; y <= cluster.last >> 16; ++y) {
    const uint row = first + y * tiles_x;
    for (uint at = row + left; at <= row + right; ++at) {
      if (!(farthest[at] < cluster.nearest)) return true;
    }
  }
  return false;
}

// Among `count` clusters from `first` on, marks those that lie behind every pixel drawn so far in
// the tiles of their box.
__kernel void hide_clusters(__constant const ClpvView* views, const uint first, const uint count,
                            __global const float* farthest, __global ClpvViewCluster* clusters,
                            const uint slices, __global uint* counts,
                            __global uint* slice_counts) {
  clear_counters(slices, counts, slice_counts);
  const uint i = get_global_id(0);
  if (i >= count) return;
  const ClpvViewCluster cluster = clusters[first + i];
  if (!may_be_seen(views[cluster.view], cluster, farthest))
    clusters[first + i].number = CLPV_HIDDEN;
}

// Only depths: a shadow map. A work-item stores W pixels of a row.
__kernel void resolve_depth(const ClpvView view, __global const realW* keys,
                            __global float* depths, const uint slices, __global uint* counts,
                            __global uint* slice_counts) {
  clear_counters(slices, counts, slice_counts);
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  store_depth(view, p, keys[p.row], depths);
}
