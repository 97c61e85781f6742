// SPDX-License-Identifier: MIT
// Appends triangles to the list of those to draw, and an entry for every tile that each may cover.
#pragma once

#include "raster/edges.h"
#include "lanes.h"
#include "raster/tile_row.h"
#include "shared/raster.h"

// W ClpvRasterTriangles, word by word.
typedef struct {
  int word[CLPV_RASTER_WORDS][W];
} RasterWords;

// Capacities of the lists of triangles and of entries.
typedef struct {
  uint list, entries;
} Capacity;

// Where a triangle's entries go.
typedef struct {
  __global uint* entries;
  volatile __global uint* slice_counts;
  __global ClpvWideTriangle* wide;
  uint view;  // number of the triangles' view
} Entries;

// Range of tiles that the box of a triangle overlaps.
typedef struct {
  int left, right, top, bottom;
} TileRange;

static inline uint tile_count(const TileRange tiles) {
  return (uint)((tiles.right - tiles.left + 1) * (tiles.bottom - tiles.top + 1));
}

// `first`, `last`: of a ClpvRasterTriangle.
static inline TileRange tiles_between(const uint first, const uint last) {
  const TileRange tiles = {(int)(first & 0xffffu) / CLPV_TILE, (int)(last & 0xffffu) / CLPV_TILE,
                       (int)(first >> 16) / CLPV_TILE, (int)(last >> 16) / CLPV_TILE};
  return tiles;
}

static inline TileRange tiles_of(const RasterWords* words, const int lane) {
  return tiles_between((uint)words->word[CLPV_FIRST_WORD][lane],
                       (uint)words->word[CLPV_LAST_WORD][lane]);
}

// Slice of a triangle with these flags and smallest key. Orthographic: slices of equal depth;
// perspective: one per doubling of the depth.
static inline uint slice_of(const ClpvView view, const uint kind, const float nearest) {
  if (kind & CLPV_TRIANGLE_MASKED) return CLPV_DEPTH_SLICES;
  if (is_orthographic(view))
    return (uint)clamp(nearest * (CLPV_DEPTH_SLICES / view.far_depth), 0.0f,
                       CLPV_DEPTH_SLICES - 1.0f);
  return (uint)clamp((as_int(-1.0f / nearest) - as_int(view.near_depth)) >> 23, 0,
                     CLPV_DEPTH_SLICES - 1);
}

// Writes an entry for triangle `index` of the list, as the next one of a tile's slice.
static inline void add_entry(__global uint* entry, const uint slice, const uint index,
                             const uint nearest, volatile __global uint* slice_counts) {
  entry[0] = slice;
  entry[1] = atomic_inc(slice_counts + slice);
  entry[2] = index;
  entry[3] = nearest;
}

// Edge function of side i of a triangle at pixel (px, py).
static inline Edge side_of(const RasterWords* words, const int i, const int lane, const int px,
                           const int py) {
  return edge_between(words->word[i][lane], words->word[4 + i][lane], words->word[i + 1][lane],
                      words->word[5 + i][lane], px, py);
}

// Writes entries of a triangle from `at` on, one for each tile of its box that it may cover.
// Returns the index after the last one.
static inline uint add_entries(const ClpvView view, const RasterWords* words, const int lane,
                             const uint index, uint at, const Entries to) {
  const uint tiles_x = tiles_across(view), first = to.view * tiles_in(view),
             nearest = (uint)words->word[CLPV_NEAREST_WORD][lane];
  const uint slice =
      slice_of(view, (uint)words->word[CLPV_TRIANGLE_WORD][lane], as_float(nearest));
  const TileRange tiles = tiles_of(words, lane);
  if (tiles.left == tiles.right && tiles.top == tiles.bottom) {
    add_entry(to.entries + CLPV_ENTRY_WORDS * at,
              (first + tiles.top * tiles_x + tiles.left) * CLPV_SLICES + slice, index, nearest,
              to.slice_counts);
    return at + 1;
  }
  const int left = tiles.left * CLPV_TILE, top = tiles.top * CLPV_TILE;
  // Scalars rather than arrays, which compilers write in 8-byte and read in 16-byte units: a
  // store-forwarding stall.
  const Edge a = side_of(words, 0, lane, left, top), b = side_of(words, 1, lane, left, top),
             c = side_of(words, 2, lane, left, top);
  long a_left = largest_in_tile(a), b_left = largest_in_tile(b), c_left = largest_in_tile(c);
  for (int y = tiles.top; y <= tiles.bottom; ++y) {
    long a_here = a_left, b_here = b_left, c_here = c_left;
    for (int x = tiles.left; x <= tiles.right; ++x) {
      if ((a_here | b_here | c_here) >= 0)
        add_entry(to.entries + CLPV_ENTRY_WORDS * at++,
                  (first + y * tiles_x + x) * CLPV_SLICES + slice, index, nearest,
                  to.slice_counts);
      a_here += CLPV_TILE * a.step_x, b_here += CLPV_TILE * b.step_x,
          c_here += CLPV_TILE * c.step_x;
    }
    a_left += CLPV_TILE * a.step_y, b_left += CLPV_TILE * b.step_y, c_left += CLPV_TILE * c.step_y;
  }
  return at;
}

// Reserves `wanted` entries and returns the index of the first. CLPV_ENTERED_TOO_MANY counts
// overflows of 32 bits.
static inline uint take_entries(volatile __global uint* counts, const uint wanted) {
  const uint at = atomic_add(counts + CLPV_ENTERED, wanted);
  if (at + wanted < at) atomic_inc(counts + CLPV_ENTERED_TOO_MANY);
  return at;
}

// Triangles to list and room for their entries; then the first of both.
typedef struct {
  uint triangles, entries;
} Places;

// Room that the triangles of the lanes in `mask` need.
static inline Places needed(const RasterWords* words, const intW mask) {
  int listed[W];
  store_lanes(mask, listed);
  Places room = {0, 0};
  for (int lane = 0; lane < W; ++lane) {
    if (!listed[lane]) continue;
    ++room.triangles;
    room.entries += tile_count(tiles_of(words, lane));
  }
  return room;
}

static inline Places reserve(volatile __global uint* counts, const Places room) {
  const Places first = {atomic_add(counts + CLPV_LISTED, room.triangles),
                        take_entries(counts, room.entries)};
  return first;
}

#if W == 1
// Reserves room of all work-items of a group at once: counters of all groups are few, and each
// takes one work-item after the other. `sums`, `base`: of the group.
static inline Places reserve_by_group(volatile __global uint* counts, const Places room,
                                      __local uint* sums, __local uint* base) {
  const bool leads = get_local_id(0) == 0;
  if (leads) sums[0] = 0, sums[1] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  Places first = {0, 0};
  if (room.triangles > 0) {
    first.triangles = atomic_add(sums, room.triangles);
    first.entries = atomic_add(sums + 1, room.entries);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (leads) {
    const Places all = {sums[0], sums[1]};
    Places at = {0, 0};
    if (all.triangles > 0) at = reserve(counts, all);
    base[0] = at.triangles, base[1] = at.entries;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  first.triangles += base[0], first.entries += base[1];
  return first;
}
#endif

// Lists the triangles of the lanes in `mask` at `first`, with their entries, except
// the entries of wide triangles, which enter_wide writes. Beyond a capacity it does nothing.
CLPV_INLINE void list_lanes(const ClpvView view, const RasterWords* words, const intW mask,
                            const Places room, const Places first, volatile __global uint* counts,
                            const Capacity capacity, __global ClpvRasterTriangle* list,
                            const Entries entries) {
  int listed[W];
  store_lanes(mask, listed);
  uint index = first.triangles, at = first.entries;
  const uint end = at + room.entries;
  if (index + room.triangles > capacity.list) return;
  const bool room_for_entries = end <= capacity.entries && end >= at;
  for (int lane = 0; lane < W; ++lane) {
    if (!listed[lane]) continue;
    __global int* to = (__global int*)(list + index);
    for (int w = 0; w < CLPV_RASTER_WORDS; ++w) to[w] = words->word[w][lane];
    const uint tiles = tile_count(tiles_of(words, lane));
    if (room_for_entries && W == 1 && tiles > CLPV_FEW_TILES) {
      const uint slot = atomic_inc(counts + CLPV_WIDE);
      // Always true, unless a 32-bit counter has overflowed.
      if (slot < capacity.entries / CLPV_FEW_TILES) {
        const ClpvWideTriangle wide = {index, at, entries.view};
        entries.wide[slot] = wide;
      }
      at += tiles;
    } else if (room_for_entries) {
      at = add_entries(view, words, lane, index, at, entries);
    }
    ++index;
  }
  for (; room_for_entries && at < end; ++at) entries.entries[CLPV_ENTRY_WORDS * at] = CLPV_NO_SLICE;
}
