// SPDX-License-Identifier: MIT
// Writing triangles to the list of those to draw, and an entry of each for every tile that it is over.
#ifndef CLPV_ENTER_TILES_H
#define CLPV_ENTER_TILES_H

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

// A side of a triangle, at a tile's upper left pixel.
static inline Edge side_of(const Words* words, const int i, const int lane, const int px, const int py) {
  return edge_between(words->word[i][lane], words->word[4 + i][lane], words->word[i + 1][lane], words->word[5 + i][lane],
                      px, py);
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
  const int left = tiles.left * CLPV_TILE, top = tiles.top * CLPV_TILE;
  // (In scalars: arrays of these are written by eights of bytes and read by sixteens, which a processor waits for.)
  const Edge a = side_of(words, 0, lane, left, top), b = side_of(words, 1, lane, left, top),
             c = side_of(words, 2, lane, left, top);
  long a_left = largest_in_tile(a), b_left = largest_in_tile(b), c_left = largest_in_tile(c);
  for (int y = tiles.top; y <= tiles.bottom; ++y) {
    long a_here = a_left, b_here = b_left, c_here = c_left;
    for (int x = tiles.left; x <= tiles.right; ++x) {
      if ((a_here | b_here | c_here) >= 0) {
        enter(entries + CLPV_ENTRY_WORDS * at++, CLPV_SLICE_AT(x, y), index, nearest, places);
      }
      a_here += CLPV_TILE * a.step_x, b_here += CLPV_TILE * b.step_x, c_here += CLPV_TILE * c.step_x;
    }
    a_left += CLPV_TILE * a.step_y, b_left += CLPV_TILE * b.step_y, c_left += CLPV_TILE * c.step_y;
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
