// SPDX-License-Identifier: MIT
// Computes the geometry volume from the coverage masks of blockers.cl: the blocked area across each
// axis at each corner.
//
//   B_a = popcount(64 bits) / 64      (docs/method.md, 'Blockers')
//
// In:   masks     coverage bits of all cascades (shared/blockers.h); cascade: number of the one to
//                 convert
// Out:  blockers  geometry volume: B_x, B_y, B_z in [0, 1] per corner, in squares of a cell's edge
// A work-item computes a corner.
#include "volume/coefficients.h"
#include "shared/blockers.h"
#include "volume/geometry.h"

__kernel void blocked_areas(__global const uint* masks, const uint cascade,
                            CLPV_VOLUME_OUT blockers) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  const int n = CLPV_GRID + 1;
  if (x >= n || y >= n) return;
  __global const uint* corner =
      masks + (size_t)cascade * CLPV_BLOCKER_MASKS + ((z * n + y) * n + x) * CLPV_BLOCKER_WORDS;
  Coefficients area;
#pragma unroll
  for (int a = 0; a < CLPV_N; ++a)
    area.c[a] = (float)(popcount(corner[2 * a]) + popcount(corner[2 * a + 1])) * (1.0f / 64.0f);
  geometry_store(blockers, 0, x, y, z, area);
}
