// SPDX-License-Identifier: MIT
// Linear interpolation from a coarser cascade to a finer one, whose cells are half as wide.
//
// Along an axis, u is the number of a finer cell from the coarser grid's origin. Its centre is (u -
// 1/2) / 2 coarser cells from the first coarser centre, always 1/4 of a cell off one, so that its
// two neighbours have the weights 3/4 and 1/4.
#pragma once

#include "sweep/sweep_layout.h"

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
