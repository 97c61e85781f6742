// SPDX-License-Identifier: MIT
// What a scene's own triangles block: for each corner of a cascade's light cells and each axis, the share of the square
// of a cell's edge across that axis that triangles inside the corner's cell cover (docs/method.md, 'Blockers').
//
//   block_triangles   sets the bits of the samples that a triangle covers
//   block_shares      counts them into a geometry volume
//
// A corner's cell is the cube of edge s about it. Along axis a, lines through 8 x 8 samples of its square are met by a
// triangle inside the cube or not: 64 bits a corner and axis, two words, bit 8 row + column. Bits are set by atomic_or, so
// that the order of triangles does not matter: union, not sum.
//
// Coordinates are block_triangle.h's, from the outermost corner's square on: the whole part of w is the number of the corner.
#include "block_triangle.h"

// The word of corner (i, j, k) counted along u, v and the axis.
static inline uint clpv_block_word(const uint axis, const int i, const int j, const int k) {
  int at[3];
  at[(axis + 1) % 3] = i;
  at[(axis + 2) % 3] = j;
  at[axis] = k;
  const int n = CLPV_GRID + 1;
  return (uint)((((int)axis * n + at[2]) * n + at[1]) * n + at[0]) * 2u;
}

// Sets a row's bits: one word where all covered samples lie in one cell, else one a cell.
CLPV_INLINE void clpv_block_row(__global volatile uint* masks, const uint axis, const int i, const int v,
                                const int8 covered, const float8 w) {
  const int8 cell = convert_int8(w + 1.0f) - 1;  // its floor, or less than 0 where that is
  const int8 lowest = covered ? cell : (int8)(CLPV_GRID + 1), highest = covered ? cell : (int8)(-1);
  const int4 low4 = min(lowest.lo, lowest.hi), high4 = max(highest.lo, highest.hi);
  const int first = max(min(min(low4.x, low4.y), min(low4.z, low4.w)), 0);
  const int last = min(max(max(high4.x, high4.y), max(high4.z, high4.w)), CLPV_GRID);
  const int row = v % CLPV_BLOCK_SAMPLES;
  for (int k = first; k <= last; ++k) {
    const uint bits = clpv_block_bits(covered & (cell == k));
    if (bits == 0) continue;
    const uint word = clpv_block_word(axis, i, v / CLPV_BLOCK_SAMPLES, k) + (uint)(row / 4);
    atomic_or(masks + word, bits << (8 * (row % 4)));
  }
}

// A work-item is a triangle; `first`: of those of the scene, the first of this launch.
__kernel void block_triangles(const ClpvGrid grid, const uint first, const uint count,
                              __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                              __global const ClpvMaterial* materials, __global const float4* textures,
                              __global const uint* texels, __global uint* masks) {
  if (get_global_id(0) >= count) return;
  const ClpvTriangle triangle = triangles[first + get_global_id(0)];
  __global const ClpvVertex* const corner[3] = {vertices + triangle.vertex[0], vertices + triangle.vertex[1],
                                                vertices + triangle.vertex[2]};
#if CLPV_MASKED
  __global const ClpvMaterial* material = materials + triangle.material;
  const bool masked = (material->flags & CLPV_MATERIAL_MASKED) != 0;
#endif
  BlockCorners corners;
  if (!clpv_block_corners(grid, corner, &corners)) return;
  int2 samples[3];  // that it may cover, along each axis
  for (int axis = 0; axis < 3; ++axis) {
    const float* at = corners.at[axis];
    samples[axis] = clpv_block_range(CLPV_GRID + 1, at[0], at[1], at[2]);
  }
  for (uint axis = 0; axis < 3; ++axis) {
    const int2 columns = samples[(axis + 1) % 3], rows = samples[(axis + 2) % 3];
    BlockTriangle t;
    if (columns.x > columns.y || rows.x > rows.y || !clpv_block_triangle(&corners, axis, &t)) continue;
    for (int v = rows.x; v <= rows.y; ++v) {
      for (int i = columns.x / CLPV_BLOCK_SAMPLES; i <= columns.y / CLPV_BLOCK_SAMPLES; ++i) {
        const float u = (float)(i * CLPV_BLOCK_SAMPLES);
        int8 covered = clpv_block_covered(&t, u, (float)v);
        if (clpv_block_bits(covered) == 0) continue;
#if CLPV_MASKED
        if (masked) covered &= clpv_block_solid(&t, corner, material, textures, texels, u, (float)v);
#endif
        clpv_block_row(masks, axis, i, v, covered, clpv_block_depth(&t, u, (float)v));
      }
    }
  }
}
