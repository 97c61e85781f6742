// SPDX-License-Identifier: MIT
// Prepares voxel masks for incremental voxelisation: moves them with their cascade, and clears the
// cells that are voxelised again (docs/method.md, 'Incremental voxelisation'; shared/region.h).
//
//   move_masks    moved = masks, shifted by region.moved; 0 where a cell enters
//   clear_masks   masks = 0 in the region's cells
//
// masks: `words` uint32 words per cell, `cells`^3 cells per cascade, of which the first `valid`
// along each axis are used. cascade: number of the cascade in `masks`. A work-item processes a
// cell.
#include "voxels/region.h"

static inline size_t mask_index(const int cells, const int words, const uint cascade, const int x,
                                const int y, const int z) {
  return ((((size_t)cascade * cells + z) * cells + y) * cells + x) * words;
}

static inline bool is_valid(const int i, const int valid) { return i >= 0 && i < valid; }

__kernel void move_masks(const ClpvRegion region, const int cells, const int valid, const int words,
                         __global const uint* masks, const uint cascade, __global uint* moved) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  if (x >= cells || y >= cells) return;
  const int from_x = x + region.moved[0], from_y = y + region.moved[1],
            from_z = z + region.moved[2];
  const bool stays = is_valid(x, valid) && is_valid(y, valid) && is_valid(z, valid) &&
                     is_valid(from_x, valid) && is_valid(from_y, valid) && is_valid(from_z, valid);
  __global uint* to = moved + mask_index(cells, words, 0, x, y, z);
  for (int i = 0; i < words; ++i) to[i] = 0;
  if (!stays) return;
  __global const uint* from = masks + mask_index(cells, words, cascade, from_x, from_y, from_z);
  for (int i = 0; i < words; ++i) to[i] = from[i];
}

__kernel void clear_masks(const ClpvRegion region, const int cells, const int words,
                          __global uint* masks, const uint cascade) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  if (x >= cells || y >= cells) return;
  const ClpvBox all = region.all;
  if (x < all.low[0] || x > all.high[0] || y < all.low[1] || y > all.high[1] || z < all.low[2] ||
      z > all.high[2])
    return;
  if (!in_region(&region, x, y, z)) return;
  __global uint* cell = masks + mask_index(cells, words, cascade, x, y, z);
  for (int i = 0; i < words; ++i) cell[i] = 0;
}
