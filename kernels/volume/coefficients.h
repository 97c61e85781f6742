// SPDX-License-Identifier: MIT
// Arithmetic on the N numbers of a cell: coefficients of the basis, and in some programs numbers of
// a blocker, of six faces, or nine harmonics. Loops over them are unrolled, so that they stay in
// registers.
//
// From the host (add_coefficient_literals): CLPV_N; CLPV_COEFFICIENT, the type of a coefficient:
// realW (W cells at once) or float (one cell).
#pragma once

#include "lanes.h"

typedef CLPV_COEFFICIENT Coefficient;
typedef struct {
  Coefficient c[CLPV_N];
} Coefficients;

// Copies into an element of an array. In a loop, rusticl loses structs that an assignment, or a
// parameter passed by value, stores there.
CLPV_INLINE void copy_coefficients(const Coefficients* from, Coefficients* to) {
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) to->c[i] = from->c[i];
}

CLPV_INLINE Coefficients zero_coefficients(void) {
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) r.c[i] = 0.0f;
  return r;
}

CLPV_INLINE Coefficients add_coefficients(const Coefficients a, const Coefficients b) {
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) r.c[i] = a.c[i] + b.c[i];
  return r;
}

// a + s b
CLPV_INLINE Coefficients add_scaled(const Coefficients a, const Coefficient s,
                                    const Coefficients b) {
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) r.c[i] = fma(s, b.c[i], a.c[i]);
  return r;
}

CLPV_INLINE Coefficients scale_coefficients(const Coefficient s, const Coefficients a) {
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) r.c[i] = s * a.c[i];
  return r;
}

CLPV_INLINE Coefficient dot_coefficients(const Coefficients a, const Coefficients b) {
  Coefficient r = 0.0f;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) r = fma(a.c[i], b.c[i], r);
  return r;
}

// sum + factor row, without the products of zeros: the product of a matrix and a vector is a sum of
// rows.
CLPV_INLINE Coefficients add_row(const Coefficients sum, const Coefficient factor,
                                 __constant const float* row) {
  Coefficients r = sum;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i)
    if (row[i] != 0.0f) r.c[i] = fma((Coefficient)(row[i]), factor, r.c[i]);
  return r;
}

// Adds constant . a, without the products of zeros.
CLPV_INLINE Coefficient add_product(const Coefficient sum, __constant const float* constants,
                                    const Coefficients a) {
  Coefficient r = sum;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i)
    if (constants[i] != 0.0f) r = fma((Coefficient)(constants[i]), a.c[i], r);
  return r;
}
