// SPDX-License-Identifier: MIT
// What triangles have left in the cells of a cascade, before more is added: moved with the cascade, and cleared where it is
// made anew. See shared/region.h.
//
//   move_masks    masks of cells that were there before -> `moved`
//   clear_masks   no masks in the region's cells
//
// CLPV_MARK_WORDS words a cell, CLPV_MARK_CELLS along each axis, of which the first CLPV_MARK_VALID are used. `cascade`: whose
// words of `masks` these are. A work-item is a cell.
#include "region.h"

#define CLPV_MARK_CELL                                                                                     \
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);              \
  if (x >= CLPV_MARK_CELLS || y >= CLPV_MARK_CELLS) return;

static inline size_t clpv_mask_at(const uint cascade, const int x, const int y, const int z) {
  return ((((size_t)cascade * CLPV_MARK_CELLS + z) * CLPV_MARK_CELLS + y) * CLPV_MARK_CELLS + x) * CLPV_MARK_WORDS;
}

static inline bool clpv_marked(const int i) { return i >= 0 && i < CLPV_MARK_VALID; }

__kernel void move_masks(const ClpvRegion region, __global const uint* masks, const uint cascade, __global uint* moved) {
  CLPV_MARK_CELL
  const int from_x = x + region.moved[0], from_y = y + region.moved[1], from_z = z + region.moved[2];
  const bool there = clpv_marked(x) && clpv_marked(y) && clpv_marked(z) && clpv_marked(from_x) &&
                     clpv_marked(from_y) && clpv_marked(from_z);
  __global uint* to = moved + clpv_mask_at(0, x, y, z);
  for (int i = 0; i < CLPV_MARK_WORDS; ++i) to[i] = 0;
  if (!there) return;
  __global const uint* from = masks + clpv_mask_at(cascade, from_x, from_y, from_z);
  for (int i = 0; i < CLPV_MARK_WORDS; ++i) to[i] = from[i];
}

__kernel void clear_masks(const ClpvRegion region, __global uint* masks, const uint cascade) {
  CLPV_MARK_CELL
  const ClpvBox all = region.all;
  if (x < all.low[0] || x > all.high[0] || y < all.low[1] || y > all.high[1] || z < all.low[2] || z > all.high[2]) return;
  if (!clpv_in_region(&region, x, y, z)) return;
  __global uint* cell = masks + clpv_mask_at(cascade, x, y, z);
  for (int i = 0; i < CLPV_MARK_WORDS; ++i) cell[i] = 0;
}
