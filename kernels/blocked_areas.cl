// SPDX-License-Identifier: MIT
// The share of set bits of each corner of the light cells and axis, as a geometry volume of areas.
//
// In: masks of blockers.cl; `cascade`: whose. Out: three numbers a corner in [0, 1], what triangles in its cell cover of a cell's square across
// x, y and z. A work-item is a corner.
#include "coefficients.h"
#include "shared/blockers.h"
#include "volume/geometry.h"

__kernel void blocked_areas(__global const uint* masks, const uint cascade, CLPV_VOLUME_OUT blockers) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  const int n = CLPV_GRID + 1;
  if (x >= n || y >= n) return;
  __global const uint* corner = masks + (size_t)cascade * CLPV_BLOCK_MASKS + ((z * n + y) * n + x) * CLPV_BLOCK_WORDS;
  Coefficients share;
#define CLPV_DO(a) \
  share.c##a = (float)(popcount(corner[2 * (a)]) + popcount(corner[2 * (a) + 1])) * (1.0f / 64.0f);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  geometry_store(blockers, 0, x, y, z, share);
}
