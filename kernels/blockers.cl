// SPDX-License-Identifier: MIT
// What a scene's own triangles block: for each corner of a cascade's light cells and each axis, the share of the square
// of a cell's edge across that axis that triangles inside the corner's cell cover (docs/method.md, 'Blockers').
//
//   voxelize_blockers   sets the bits of the samples that a triangle covers
//   blocked_areas      counts them into a geometry volume
//
// A corner's cell is the cube of edge s about it. Along axis a, lines through 8 x 8 samples of its square are met by a
// triangle inside the cube or not: 64 bits a corner and axis, two words after each other, bit 8 row + column. Bits are set by atomic_or, so
// that the order of triangles does not matter: union, not sum.
//
// Coordinates are voxelize_triangle.h's: the whole part of w is the number of the corner, counted from the region's base.
#include "voxelize_triangle.h"
#include "shared/blockers.h"

// The word of corner (i, j, k) counted along u, v and the axis from the base, or none where it is not made anew.
#define CLPV_NO_WORD 0xffffffffu
static inline uint clpv_block_word(const ClpvRegion* region, const uint axis, const int i, const int j, const int k) {
  int at[3];
  at[(axis + 1) % 3] = i;
  at[(axis + 2) % 3] = j;
  at[axis] = k;
  const int x = at[0] - region->first[0], y = at[1] - region->first[1], z = at[2] - region->first[2];
  if (!clpv_in_region(region, x, y, z)) return CLPV_NO_WORD;
  const int n = CLPV_GRID + 1;
  return (uint)((z * n + y) * n + x) * CLPV_BLOCK_WORDS + axis * 2u;
}

// Sets a row's bits: one word where all covered samples lie in one cell, else one a cell.
CLPV_INLINE void clpv_block_row(const ClpvRegion* region, __global volatile uint* masks, const uint axis, const int i,
                                const int v, const int8 covered, const float8 w) {
  const int2 cells = clpv_cells_along(region, axis);
  const int8 cell = convert_int8(w + 1.0f) - 1;  // its floor, or less than 0 where that is
  const int8 lowest = covered ? cell : (int8)(cells.y + 1), highest = covered ? cell : (int8)(-1);
  const int4 low4 = min(lowest.lo, lowest.hi), high4 = max(highest.lo, highest.hi);
  const int first = max(min(min(low4.x, low4.y), min(low4.z, low4.w)), cells.x);
  const int last = min(max(max(high4.x, high4.y), max(high4.z, high4.w)), cells.y);
  const int row = v % CLPV_BLOCK_SAMPLES;
  for (int k = first; k <= last; ++k) {
    const uint bits = clpv_bits(covered & (cell == k));
    if (bits == 0) continue;
    const uint word = clpv_block_word(region, axis, i, v / CLPV_BLOCK_SAMPLES, k);
    if (word != CLPV_NO_WORD) atomic_or(masks + word + row / 4, bits << (8 * (row % 4)));
  }
}

// A work-item is a triangle. `cascade`: whose masks these are.
__kernel void voxelize_blockers(const ClpvRegion region, CLPV_TRIANGLES, __global const float4* textures,
                              __global const uint* texels, __global uint* all_masks, const uint cascade) {
  const uint number = CLPV_TRIANGLE_NUMBER;
  if (number >= triangle_count) return;
  const ClpvTriangle triangle = triangles[number];
  __global uint* masks = all_masks + (size_t)cascade * CLPV_BLOCK_MASKS;
  __global const ClpvVertex* const corner[3] = {vertices + triangle.vertex[0], vertices + triangle.vertex[1],
                                                vertices + triangle.vertex[2]};
#if CLPV_MASKED
  __global const ClpvMaterial* material = materials + triangle.material;
  const bool masked = (material->flags & CLPV_MATERIAL_MASKED) != 0;
#endif
  BlockCorners corners;
  if (!clpv_block_corners(&region, corner, &corners)) return;
  int2 samples[3];  // that it may cover, along each axis
  for (int axis = 0; axis < 3; ++axis) {
    const float* at = corners.at[axis];
    const int2 cells = clpv_cells_along(&region, axis);
    samples[axis] = clpv_block_range(cells.x, cells.y, at[0], at[1], at[2]);
  }
  for (uint axis = 0; axis < 3; ++axis) {
    const int2 columns = samples[(axis + 1) % 3], rows = samples[(axis + 2) % 3];
    BlockTriangle t;
    if (columns.x > columns.y || rows.x > rows.y || !clpv_block_triangle(&corners, axis, &t)) continue;
    for (int v = rows.x; v <= rows.y; ++v) {
      for (int i = columns.x / CLPV_BLOCK_SAMPLES; i <= columns.y / CLPV_BLOCK_SAMPLES; ++i) {
        const float u = (float)(i * CLPV_BLOCK_SAMPLES);
        int8 covered = clpv_block_covered(&t, u, (float)v);
        if (clpv_bits(covered) == 0) continue;
#if CLPV_MASKED
        if (masked) covered &= clpv_block_solid(&t, corner, material, textures, texels, u, (float)v);
#endif
        clpv_block_row(&region, masks, axis, i, v, covered, clpv_block_depth(&t, u, (float)v));
      }
    }
  }
}
