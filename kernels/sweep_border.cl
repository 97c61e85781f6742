// SPDX-License-Identifier: MIT
// What comes in at a cascade's border, along each direction: the coarser cascade's light in the cells round the grid.
//
// In: `kept`, the coarser cascade's shell (sweep.cl). Out: `border`, for each direction and channel three faces of rows
// as a plane's (sweep.h): the plane before the first one, and of each plane the row and the column before its first ones.
// Radiance is the same in both cascades; what 1 of the coarser one's light is here, ClpvSweepDirection says.
//
// dx, dy, dz: from the coarser grid's least corner to the finer one's, in finer cells (finer.h). A work-item is eight cells
// of a row, from the one before the grid's first on.
#include "finer.h"
#include "shared/sweep.h"
#include "sweep.h"

__kernel void sweep_border(__constant const ClpvSweepBin* bins, __constant const ClpvSweepDirection* directions,
                           __global const float* kept, const ClpvSweepShell shell, const int dx, const int dy,
                           const int dz, __global float* border) {
  const int column = 8 * (int)get_global_id(0) - 1, row = (int)get_global_id(1) - 1, face = (int)get_global_id(2) % 3;
  const int swept = (int)get_global_id(2) / 3, b = swept / (3 * CLPV_PARTS);
  if (column > CLPV_GRID || row > CLPV_GRID) return;
  const ClpvSweepBin bin = bins[b];
  __constant const ClpvSweepDirection* direction = directions + b * CLPV_PARTS + swept % CLPV_PARTS;
  const int across = face == 0 ? bin.plane_axis : (face == 1 ? bin.row_axis : bin.column_axis);
  const int sign = face == 0 ? bin.plane_sign : (face == 1 ? bin.row_sign : bin.column_sign);
  const int row_axis = face == 0 ? bin.row_axis : bin.plane_axis;
  const int column_axis = face == 2 ? bin.row_axis : bin.column_axis;
#define CLPV_OFFSET(axis) ((axis) == 0 ? dx : ((axis) == 1 ? dy : dz))
  const int layer = (sign > 0 ? -1 : CLPV_GRID) + CLPV_OFFSET(across);
  const int r = row + CLPV_OFFSET(row_axis), c = column + CLPV_OFFSET(column_axis);
  const int pitch = shell.side + 8, next = shell.side * pitch;
  const int from = (swept / CLPV_PARTS * CLPV_COARSER_PARTS + direction->coarser) * 3 + face;
  __global const float* light = kept + from * (2 * next + 8) + (CLPV_LOWER(r) - shell.first[row_axis]) * pitch +
                                CLPV_LOWER(c) - shell.first[column_axis];
  const float tl = CLPV_UPPER_WEIGHT(layer), tr = CLPV_UPPER_WEIGHT(r);
  const float8 lower = (1.0f - tr) * vload8(0, light) + tr * vload8(0, light + pitch);
  const float8 upper = (1.0f - tr) * vload8(0, light + next) + tr * vload8(0, light + next + pitch);
  const float8 v = direction->from_coarser * ((1.0f - tl) * lower + tl * upper);
  vstore8(c & 1 ? CLPV_ODD(v) : CLPV_EVEN(v), 0,
          border + swept * 3 * CLPV_SWEEP_LIVE + face * CLPV_SWEEP_LIVE + (row + 1) * CLPV_SWEEP_PITCH +
              CLPV_SWEEP_FIRST + column);
}
