// SPDX-License-Identifier: MIT
// Prepares voxel masks for incremental voxelisation: moves them with their cascade, and clears the cells that are
// voxelised again (docs/method.md, 'Incremental voxelisation'; shared/region.h).
//
//   move_masks    moved = masks, shifted by region.moved; 0 where a cell enters
//   clear_masks   masks = 0 in the region's cells
//
// masks: CLPV_MASK_WORDS uint32 words per cell, CLPV_MASK_CELLS^3 cells per cascade, of which the first CLPV_MASK_VALID
// along each axis are used. cascade: number of the cascade in `masks`. A work-item processes a cell.
#include "region.h"

#define CLPV_THIS_CELL                                                                       \
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2); \
  if (x >= CLPV_MASK_CELLS || y >= CLPV_MASK_CELLS) return;

static inline size_t clpv_mask_at(const uint cascade, const int x, const int y, const int z) {
  return ((((size_t)cascade * CLPV_MASK_CELLS + z) * CLPV_MASK_CELLS + y) * CLPV_MASK_CELLS + x) * CLPV_MASK_WORDS;
}

static inline bool clpv_valid(const int i) { return i >= 0 && i < CLPV_MASK_VALID; }

__kernel void move_masks(const ClpvRegion region, __global const uint* masks, const uint cascade,
                         __global uint* moved) {
  CLPV_THIS_CELL
  const int from_x = x + region.moved[0], from_y = y + region.moved[1], from_z = z + region.moved[2];
  const bool stays = clpv_valid(x) && clpv_valid(y) && clpv_valid(z) && clpv_valid(from_x) && clpv_valid(from_y) &&
                     clpv_valid(from_z);
  __global uint* to = moved + clpv_mask_at(0, x, y, z);
  for (int i = 0; i < CLPV_MASK_WORDS; ++i) to[i] = 0;
  if (!stays) return;
  __global const uint* from = masks + clpv_mask_at(cascade, from_x, from_y, from_z);
  for (int i = 0; i < CLPV_MASK_WORDS; ++i) to[i] = from[i];
}

__kernel void clear_masks(const ClpvRegion region, __global uint* masks, const uint cascade) {
  CLPV_THIS_CELL
  const ClpvBox all = region.all;
  if (x < all.low[0] || x > all.high[0] || y < all.low[1] || y > all.high[1] || z < all.low[2] || z > all.high[2]) return;
  if (!clpv_in_region(&region, x, y, z)) return;
  __global uint* cell = masks + clpv_mask_at(cascade, x, y, z);
  for (int i = 0; i < CLPV_MASK_WORDS; ++i) cell[i] = 0;
}
