// SPDX-License-Identifier: MIT
// Packs the accumulated volume of a cascade into records for gathering (gather_packed.h).
//
// In:   volume  light volume [W/sr], any layout
// Out:  packed  a record of CLPV_PAIRS float8 per cell, from record `first` on
// From the host (host/codegen/gather_source.cpp): CLPV_EACH_PAIR(DO), which writes DO(j, even, odd) for each pair of
// coefficients; even(c), odd(c) are its members of Coefficients c in lane `lane`. A work-item packs W cells of
// a row.
#include "volume/coefficients.h"
#include "volume/light.h"
#include "volume/whole_groups.h"

__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, 1, 1))) void pack(
    CLPV_VOLUME_IN volume, __global float8* packed, const uint first) {
  const int x = W * (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  CLPV_RETURN_OUTSIDE(x, y);
  const Coefficients r = light_load(volume, 0, x, y, z), g = light_load(volume, 1, x, y, z),
                     b = light_load(volume, 2, x, y, z);
  __global float8* record = packed + (size_t)(first + (z * CLPV_GRID + y) * CLPV_GRID + x) * CLPV_PAIRS;
  const int cells = min(W, CLPV_GRID - x);
  for (int lane = 0; lane < W; ++lane, record += CLPV_PAIRS) {
    if (lane >= cells) break;
#define CLPV_DO(j, even, odd) \
  record[j] = (float8)(even(r), even(g), even(b), 0.0f, odd(r), odd(g), odd(b), 0.0f);
    CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
  }
}
