// SPDX-License-Identifier: MIT
// What comes in at the coarsest cascade's border from a sky, along each direction: the same everywhere.
//
// In: `sky`, of each direction and channel what comes in through cells of 1 m^2; `scale`, what to take it times: their area, and
// what volumes hold in place of 1 W/sr. Out: as of sweep_border.cl, and by the same work-items.
#include "shared/sweep.h"
#include "sweep.h"
#include "sweep_border.h"

__kernel void sweep_sky(__global const float* sky, const float scale, __global float* live, const int before,
                        CLPV_BUFFER_OUT border) {
  const int column = 8 * (int)get_global_id(0) - 1, row = (int)get_global_id(1) - 1, face = (int)get_global_id(2) % 3;
  const int swept = (int)get_global_id(2) / 3;
  if (column > CLPV_GRID || row > CLPV_GRID) return;
  const float8 in = scale * sky[swept];
  if (face == CLPV_BORDER_PLANE) {
    vstore8(in, 0, live + before + swept * CLPV_SWEEP_LIVE + clpv_live_at(row, column));
  } else {
    CLPV_WRITE_ROW(border, clpv_side_at(swept, face, row, column), in);
  }
}
