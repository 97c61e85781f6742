// SPDX-License-Identifier: MIT
// Writing triangles to the list of those to draw, and an entry of each for every tile that it is over.
#ifndef CLPV_ENTER_H
#define CLPV_ENTER_H

#include "edges.h"
#include "lanes.h"
#include "shared/raster.h"

// Eight ClpvRasterTriangles, word by word.
typedef struct {
  int word[CLPV_RASTER_WORDS][CLPV_ABREAST];
} Words;

// How many triangles and entries there is room for.
typedef struct {
  uint list, entries;
} Capacity;

// The tiles that a box reaches into.
typedef struct {
  int left, right, top, bottom;
} Tiles;

static inline Tiles tiles_of(const Words* words, const int lane) {
  const uint first = (uint)words->word[13][lane], last = (uint)words->word[14][lane];
  const Tiles tiles = {(int)(first & 0xffffu) / CLPV_TILE, (int)(last & 0xffffu) / CLPV_TILE,
                       (int)(first >> 16) / CLPV_TILE, (int)(last >> 16) / CLPV_TILE};
  return tiles;
}

// The slice that a triangle of this least key is in: equal ones along parallel rays, else one for each doubling of the
// depth.
static inline uint slice_of(const ClpvView view, const float nearest) {
  if (CLPV_PARALLEL(view)) return (uint)clamp(nearest * (CLPV_SLICES / view.far_depth), 0.0f, CLPV_SLICES - 1.0f);
  return (uint)clamp((as_int(-1.0f / nearest) - as_int(view.near_depth)) >> 23, 0, CLPV_SLICES - 1);
}

// An entry of triangle `index` of the list, as the next one of a tile's slice.
static inline void enter(__global uint* entry, const uint slice, const uint index, const uint nearest,
                         volatile __global uint* places) {
  entry[0] = slice;
  entry[1] = atomic_inc(places + slice);
  entry[2] = index;
  entry[3] = nearest;
}

// Enters a triangle for each tile of its box that it may cover a pixel of. Returns where its entries end.
static inline uint enter_all(const ClpvView view, const Words* words, const int lane, const uint index, uint at,
                             __global uint* entries, volatile __global uint* places) {
  const uint tiles_x = (view.width + CLPV_TILE - 1) / CLPV_TILE, nearest = (uint)words->word[11][lane];
  const uint slice = slice_of(view, as_float(nearest));
  const Tiles tiles = tiles_of(words, lane);
#define CLPV_SLICE_AT(x, y) (((uint)(y) * tiles_x + (uint)(x)) * CLPV_SLICES + slice)
  if (tiles.left == tiles.right && tiles.top == tiles.bottom) {
    enter(entries + CLPV_ENTRY_WORDS * at, CLPV_SLICE_AT(tiles.left, tiles.top), index, nearest, places);
    return at + 1;
  }
  long at_left[3], step_x[3], step_y[3];
  for (int i = 0; i < 3; ++i) {
    const Edge edge = edge_between(words->word[i][lane], words->word[4 + i][lane], words->word[i + 1][lane],
                                   words->word[5 + i][lane], tiles.left * CLPV_TILE, tiles.top * CLPV_TILE);
    at_left[i] = largest_in_tile(edge);
    step_x[i] = CLPV_TILE * edge.step_x;
    step_y[i] = CLPV_TILE * edge.step_y;
  }
  for (int y = tiles.top; y <= tiles.bottom; ++y) {
    long e0 = at_left[0], e1 = at_left[1], e2 = at_left[2];
    for (int x = tiles.left; x <= tiles.right; ++x) {
      if ((e0 | e1 | e2) >= 0) {
        enter(entries + CLPV_ENTRY_WORDS * at++, CLPV_SLICE_AT(x, y), index, nearest, places);
      }
      e0 += step_x[0], e1 += step_x[1], e2 += step_x[2];
    }
    at_left[0] += step_y[0], at_left[1] += step_y[1], at_left[2] += step_y[2];
  }
#undef CLPV_SLICE_AT
  return at;
}

// Takes `wanted` places of entries; a count beyond 32 bits is told by CLPV_ENTERED_TOO_MANY.
static inline uint take_entries(volatile __global uint* counts, const uint wanted) {
  const uint at = atomic_add(counts + CLPV_ENTERED, wanted);
  if (at + wanted < at) atomic_inc(counts + CLPV_ENTERED_TOO_MANY);
  return at;
}

// Lists and enters those lanes of `lists` that are to be.
CLPV_INLINE void list_lanes(const ClpvView view, const Words* words, const int8 lists, volatile __global uint* counts,
                            const Capacity capacity, __global ClpvRasterTriangle* list, __global uint* entries,
                            volatile __global uint* places) {
  int listed[CLPV_ABREAST];
  vstore8(lists, 0, listed);
  uint triangles = 0, room = 0;
  for (int lane = 0; lane < CLPV_ABREAST; ++lane) {
    if (!listed[lane]) continue;
    const Tiles tiles = tiles_of(words, lane);
    ++triangles;
    room += (uint)((tiles.right - tiles.left + 1) * (tiles.bottom - tiles.top + 1));
  }
  uint index = atomic_add(counts + CLPV_LISTED, triangles), at = take_entries(counts, room);
  const uint end = at + room;
  if (index + triangles > capacity.list || end > capacity.entries || end < at) return;
  for (int lane = 0; lane < CLPV_ABREAST; ++lane) {
    if (!listed[lane]) continue;
    __global int* to = (__global int*)(list + index);
    for (int w = 0; w < CLPV_RASTER_WORDS; ++w) to[w] = words->word[w][lane];
    at = enter_all(view, words, lane, index++, at, entries, places);
  }
  for (; at < end; ++at) entries[CLPV_ENTRY_WORDS * at] = CLPV_NO_SLICE;
}

#endif
