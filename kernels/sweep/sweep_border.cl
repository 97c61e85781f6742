// SPDX-License-Identifier: MIT
// Sets the boundary condition of a cascade from the next coarser cascade: light along each
// direction in the cells just outside the grid, interpolated trilinearly.
//
//   D = from_coarser D_coarser      (radiance is equal in both: D = L s^2 |w_m|)
//
// docs/method.md, 'The sweep'; from_coarser is in ClpvSweepDirection.
//
// In:   halo_light    D_coarser [W/sr] in the cells of `halo` (sweep_border.h)
//       dx, dy, dz    offset of the grid's origin from the coarser one's, in finer cells
//       first_lit     channels below have a dark border
// Out:  plane_buffer  D [W/sr] in the plane upstream of the grid, from number `upstream` on
//       border        D [W/sr] in the rows and columns upstream of each plane
// A work-item computes W cells of a row of one face, from the cell before the grid on.
// From the host: CLPV_COARSER_PARTS, directions of a bin in the coarser cascade.
#include "shared/sweep.h"
#include "sweep/sweep_layout.h"
#include "sweep/sweep_border.h"

// Along an axis, u is the number of a finer cell from the coarser grid's origin. Its centre is (u -
// 1/2) / 2 coarser cells from the first coarser centre, always 1/4 of a cell off one, so that its
// two neighbours have the weights 3/4 and 1/4.

// Lower one of the two coarser cells about finer cell u, and the weight of the upper one.
static inline int lower_cell(const int u) { return (u - 1) >> 1; }
static inline float upper_weight(const int u) { return u & 1 ? 0.25f : 0.75f; }

#if W == 8
// Finer cells u to u + 7, from eight coarser cells that start with lower_cell(u); for odd and even
// u.
CLPV_INLINE float8 interpolate_odd(const float8 v) {
  return 0.75f * (float8)(v.s0, v.s1, v.s1, v.s2, v.s2, v.s3, v.s3, v.s4) +
         0.25f * (float8)(v.s1, v.s0, v.s2, v.s1, v.s3, v.s2, v.s4, v.s3);
}
CLPV_INLINE float8 interpolate_even(const float8 v) {
  return 0.75f * (float8)(v.s1, v.s1, v.s2, v.s2, v.s3, v.s3, v.s4, v.s4) +
         0.25f * (float8)(v.s0, v.s2, v.s1, v.s3, v.s2, v.s4, v.s3, v.s5);
}
#endif

// W cells between four rows, which start at `at`, at + row, at + plane and at + row + plane.
// `row_weight`: weight of the rows at + row; `plane_weight` likewise.
CLPV_INLINE realW interpolate_rows(CLPV_BUFFER_IN from, const int at, const int row,
                                   const int plane, const float row_weight,
                                   const float plane_weight) {
  return (1.0f - plane_weight) * ((1.0f - row_weight) * read_numbers(from, at) +
                                  row_weight * read_numbers(from, at + row)) +
         plane_weight * ((1.0f - row_weight) * read_numbers(from, at + plane) +
                         row_weight * read_numbers(from, at + plane + row));
}

__kernel void sweep_border(__constant const ClpvSweepBin* bins,
                           __constant const ClpvSweepDirection* directions,
                           CLPV_BUFFER_IN halo_light, const ClpvSweepHalo halo, const int dx,
                           const int dy, const int dz, const int first_lit,
                           __global float* plane_buffer, const int upstream,
                           CLPV_BUFFER_OUT border) {
  const int column = W * (int)get_global_id(0) - 1, row = (int)get_global_id(1) - 1,
            face = (int)get_global_id(2) % 3;
  const int ordinate = (int)get_global_id(2) / 3, b = ordinate / (3 * CLPV_PARTS);
  if (column > CLPV_GRID || row > CLPV_GRID) return;
  const ClpvSweepBin bin = bins[b];
  __constant const ClpvSweepDirection* direction =
      directions + b * CLPV_PARTS + ordinate % CLPV_PARTS;
  const bool plane_face = face == CLPV_BORDER_PLANE, row_face = face == CLPV_BORDER_ROW;
  const int across = plane_face ? bin.plane_axis : (row_face ? bin.row_axis : bin.column_axis);
  const int sign = plane_face ? bin.plane_sign : (row_face ? bin.row_sign : bin.column_sign);
  const int row_axis = plane_face ? bin.row_axis : bin.plane_axis;
  const int column_axis = face == CLPV_BORDER_COLUMN ? bin.row_axis : bin.column_axis;
  const int layer = (sign > 0 ? -1 : CLPV_GRID) + along_axis(across, dx, dy, dz);
  const int r = row + along_axis(row_axis, dx, dy, dz),
            c = column + along_axis(column_axis, dx, dy, dz);
  const int pitch = halo_pitch(halo.side), next = halo.side * pitch;
  const int coarser = ordinate / CLPV_PARTS * CLPV_COARSER_PARTS + direction->coarser;
  CLPV_BUFFER_IN light =
      halo_light + halo_index(halo, coarser, face, 0, lower_cell(r) - halo_first(halo, row_axis),
                              lower_cell(c) - halo_first(halo, column_axis));
  const float tl = upper_weight(layer), tr = upper_weight(r);
  const float from_coarser =
      ordinate / CLPV_PARTS % 3 < first_lit ? 0.0f : direction->from_coarser;
  const realW v = from_coarser * interpolate_rows(light, 0, pitch, next, tr, tl);
#if W == 8
  const realW in = c & 1 ? interpolate_odd(v) : interpolate_even(v);
#else
  const float tc = upper_weight(c);
  const realW in = (1.0f - tc) * v +
                   tc * from_coarser * interpolate_rows(light, 1, pitch, next, tr, tl);
#endif
  if (plane_face) {
    store_lanes(
        in, plane_buffer + upstream + ordinate * CLPV_BORDERED_PLANE + plane_index(row, column));
  } else {
    write_numbers(border, border_index(ordinate, face, row, column), in);
  }
}
