// SPDX-License-Identifier: MIT
// What comes in at a cascade's border, along each direction: the coarser cascade's light in the cells round the grid.
//
// In: `kept`, the coarser cascade's halo. Out: the planes before the first ones, in `live` from number `before` on, and
// the other sides, in `border` (sweep_border.h).
// Radiance is the same in both cascades; what 1 of the coarser one's light is here, ClpvSweepDirection says.
//
// dx, dy, dz: from the coarser grid's least corner to the finer one's, in finer cells (coarse_to_fine.h). A work-item is eight cells
// of a row, from the one before the grid's first on.
#include "coarse_to_fine.h"
#include "shared/sweep.h"
#include "sweep.h"
#include "sweep_border.h"

__kernel void sweep_border(__constant const ClpvSweepBin* bins, __constant const ClpvSweepDirection* directions,
                           CLPV_BUFFER_IN kept, const ClpvSweepHalo halo, const int dx, const int dy, const int dz,
                           __global float* live, const int before, CLPV_BUFFER_OUT border) {
  const int column = 8 * (int)get_global_id(0) - 1, row = (int)get_global_id(1) - 1, face = (int)get_global_id(2) % 3;
  const int swept = (int)get_global_id(2) / 3, b = swept / (3 * CLPV_PARTS);
  if (column > CLPV_GRID || row > CLPV_GRID) return;
  const ClpvSweepBin bin = bins[b];
  __constant const ClpvSweepDirection* direction = directions + b * CLPV_PARTS + swept % CLPV_PARTS;
  const bool plane_face = face == CLPV_BORDER_PLANE, row_face = face == CLPV_BORDER_ROW;
  const int across = plane_face ? bin.plane_axis : (row_face ? bin.row_axis : bin.column_axis);
  const int sign = plane_face ? bin.plane_sign : (row_face ? bin.row_sign : bin.column_sign);
  const int row_axis = plane_face ? bin.row_axis : bin.plane_axis;
  const int column_axis = face == CLPV_BORDER_COLUMN ? bin.row_axis : bin.column_axis;
#define CLPV_OFFSET(axis) ((axis) == 0 ? dx : ((axis) == 1 ? dy : dz))
  const int layer = (sign > 0 ? -1 : CLPV_GRID) + CLPV_OFFSET(across);
  const int r = row + CLPV_OFFSET(row_axis), c = column + CLPV_OFFSET(column_axis);
  const int pitch = CLPV_SWEEP_HALO_PITCH_OF(halo.side), next = halo.side * pitch;
  const int from = swept / CLPV_PARTS * CLPV_COARSER_PARTS + direction->coarser;
  CLPV_BUFFER_IN light = kept + clpv_halo_at(halo, from, face, 0, CLPV_LOWER(r) - CLPV_HALO_FIRST(halo, row_axis),
                                                     CLPV_LOWER(c) - CLPV_HALO_FIRST(halo, column_axis));
  const float tl = CLPV_UPPER_WEIGHT(layer), tr = CLPV_UPPER_WEIGHT(r);
  const float8 lower = (1.0f - tr) * CLPV_READ_ROW(light, 0) + tr * CLPV_READ_ROW(light, pitch);
  const float8 upper = (1.0f - tr) * CLPV_READ_ROW(light, next) + tr * CLPV_READ_ROW(light, next + pitch);
  const float8 v = direction->from_coarser * ((1.0f - tl) * lower + tl * upper);
  const float8 in = c & 1 ? CLPV_ODD(v) : CLPV_EVEN(v);
  if (plane_face) {
    vstore8(in, 0, live + before + swept * CLPV_SWEEP_LIVE + clpv_live_at(row, column));
  } else {
    CLPV_WRITE_ROW(border, clpv_side_at(swept, face, row, column), in);
  }
}
