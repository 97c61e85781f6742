// SPDX-License-Identifier: MIT
// Cosine lobes in a basis: integrals alpha, flux, and projection.
//
//   c(n) = A^-1 alpha(n),   A = L L^T the Gram matrix      (docs/bases.md)
//
// A^-1 is two triangular systems: a float A^-1 would have 20x the rounding error for srbf14.
//
// From the host (lobe_literals, host/pipeline/inject/lookup_table.hpp): CLPV_FLUX_WEIGHTS,
// CLPV_GRAM_LOWER (L) and CLPV_GRAM_INVERSE_DIAGONAL; CLPV_ROTATED 1: lobes are rotated
// (rotated_lobe.h), and the table of H is an argument before the table of G. Flux weights:
// A^-1 Int b. CLPV_AND_H ends parameter lists, CLPV_PASS_H calls.
#pragma once

#include "basis/basis.h"

__constant const float flux_weights[CLPV_N] = CLPV_FLUX_WEIGHTS;
__constant const float gram_lower[CLPV_N][CLPV_N] = CLPV_GRAM_LOWER;
__constant const float gram_inverse_diagonal[CLPV_N] = CLPV_GRAM_INVERSE_DIAGONAL;

// lobe_integrals(x, y, z): alpha of the lobe about the unit normal (x, y, z); with CLPV_ROTATED,
// alpha of the rotated projection.
#if CLPV_ROTATED
#include "basis/rotated_lobe.h"
#define CLPV_AND_H , CLPV_TABLE singular_table
#define CLPV_PASS_H , singular_table
#define lobe_integrals rotated_integrals
#else
#define CLPV_AND_H
#define CLPV_PASS_H
#define lobe_integrals cosine_integrals
#endif

// Integral [sr] of the lobe with integrals alpha.
CLPV_INLINE float lobe_flux(const Coefficients alpha) {
  return add_product(0.0f, flux_weights, alpha);
}

// A^-1 a. The second inner loop begins at 0: from i + 1, rusticl of Mesa 26.2 crashes.
CLPV_INLINE Coefficients project_sum(const Coefficients a) {
  Coefficients r = a;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) {
#pragma unroll
    for (int j = 0; j < i; ++j)
      if (gram_lower[i][j] != 0.0f) r.c[i] = fma(-gram_lower[i][j], r.c[j], r.c[i]);
    r.c[i] *= gram_inverse_diagonal[i];
  }
#pragma unroll
  for (int i = CLPV_N - 1; i >= 0; --i) {
#pragma unroll
    for (int j = 0; j < CLPV_N; ++j)
      if (j > i && gram_lower[j][i] != 0.0f) r.c[i] = fma(-gram_lower[j][i], r.c[j], r.c[i]);
    r.c[i] *= gram_inverse_diagonal[i];
  }
  return r;
}
