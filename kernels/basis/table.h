// SPDX-License-Identifier: MIT
// The paper's look-up tables of functions of t in [-1, 1]: entry int((t + 1) / 2 (size - 1)),
// without interpolation.
//
//   table of G    b_i(w) = G(w . xi_i; lambda_i)                  table_functions
//   table of H    H_ij(t) = 4 pi G(t; lambda_i lambda_j)          rotated_lobe.h
//
// A table has one part of CLPV_TABLE_SIZE entries for each lambda, or each product of two. Rounding
// decides entries: rounded_dot() rounds products and sums one by one, in the order of x, y, z, as
// host/basis/rotated_lobe.hpp does. Kernels rotate centres with fma(), the host in double, so they
// may still read neighbouring entries.
//
// From the host: CLPV_TABLE_IMAGE 1: a table is a 1-D image of a buffer, else a buffer;
// CLPV_TABLE_SIZE; CLPV_POISSON_PARTS, the part of G for each function.
#pragma once

#include "basis/radial.h"

#if CLPV_TABLE_IMAGE
#define CLPV_TABLE __read_only image1d_buffer_t
CLPV_INLINE float table_entry(CLPV_TABLE table, const int i) { return read_imagef(table, i).x; }
#else
#define CLPV_TABLE __global const float*
CLPV_INLINE float table_entry(CLPV_TABLE table, const int i) { return table[i]; }
#endif

__constant const int poisson_parts[CLPV_N] = CLPV_POISSON_PARTS;

// centre . (x, y, z)
CLPV_INLINE float rounded_dot(__constant const float* centre, const float x, const float y,
                              const float z) {
#pragma OPENCL FP_CONTRACT OFF
  const float w[3] = {x, y, z};
  float sum = -0.0f;  // compilers leave out its addition, which changes no number
#pragma unroll
  for (int axis = 0; axis < 3; ++axis)
    if (centre[axis] != 0.0f) sum = sum + centre[axis] * w[axis];
  return sum;
}

// Value at t of a part of a table.
CLPV_INLINE float read_table(CLPV_TABLE table, const int part, const float t) {
  const int entry = (int)((t + 1.0f) * (0.5f * (CLPV_TABLE_SIZE - 1)));
  return table_entry(table, part * CLPV_TABLE_SIZE + clamp(entry, 0, CLPV_TABLE_SIZE - 1));
}

// b_i(w) of the unit vector w = (x, y, z).
CLPV_INLINE Coefficients table_functions(const float x, const float y, const float z,
                                         CLPV_TABLE poisson_table) {
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i)
    r.c[i] = read_table(poisson_table, poisson_parts[i], rounded_dot(centres[i], x, y, z));
  return r;
}
