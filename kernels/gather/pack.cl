// SPDX-License-Identifier: MIT
// Packs the accumulated volume of a cascade into records for gathering (gather_packed.h).
//
// In:   volume  light volume [W/sr], any layout
//       white   factor of the white furnace in channel 3, with CLPV_FURNACE
// Out:  packed  a record of CLPV_PAIRS float8 per cell, from record `first` on
// From the host: CLPV_PAIRS, CLPV_FURNACE. A work-item packs W cells of a row.
#include "volume/coefficients.h"
#include "volume/light.h"
#include "volume/whole_groups.h"

// Coefficient i of a lane; 0 after the last one.
CLPV_INLINE float number_at(const Coefficients* cell, const int i, const int lane) {
  return i < CLPV_N ? ((const float*)&cell->c[min(i, CLPV_N - 1)])[lane] : 0.0f;
}

__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, 1, 1))) void pack(
    CLPV_VOLUME_IN volume, __global float8* packed, const uint first, const float white) {
  const int x = W * (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  if (outside_grid(x, y)) return;
  const Coefficients r = light_load(volume, 0, x, y, z), g = light_load(volume, 1, x, y, z),
                     b = light_load(volume, 2, x, y, z);
  Coefficients f = zero_coefficients();
  if (CLPV_FURNACE) f = scale_coefficients(white, light_load(volume, 3, x, y, z));
  __global float8* record =
      packed + (size_t)(first + (z * CLPV_GRID + y) * CLPV_GRID + x) * CLPV_PAIRS;
  const int cells = min(W, CLPV_GRID - x);
  for (int lane = 0; lane < W; ++lane, record += CLPV_PAIRS) {
    if (lane >= cells) break;
#pragma unroll
    for (int j = 0; j < CLPV_PAIRS; ++j) {
      const int even = 2 * j, odd = even + 1;
      record[j] = (float8)(number_at(&r, even, lane), number_at(&g, even, lane),
                           number_at(&b, even, lane), number_at(&f, even, lane),
                           number_at(&r, odd, lane), number_at(&g, odd, lane),
                           number_at(&b, odd, lane), number_at(&f, odd, lane));
    }
  }
}
