// SPDX-License-Identifier: MIT
// Arithmetic on the N coefficients of a cell, a struct of named scalars, so that work-items vectorise (lanes.h).
//
// From the host (coefficient_macros), since generated text before this file uses them: CLPV_N, type Coefficient (realW,
// or float where one cell is read at a time), struct Coefficients, and CLPV_EACH_COEFFICIENT(DO), which writes DO(0)
// DO(1) ... DO(N - 1).
#ifndef CLPV_COEFFICIENTS_H
#define CLPV_COEFFICIENTS_H

CLPV_INLINE Coefficients zero_coefficients(void) {
  Coefficients r;
#define CLPV_DO(i) r.c##i = 0.0f;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return r;
}

CLPV_INLINE Coefficients add_coefficients(const Coefficients a, const Coefficients b) {
  Coefficients r;
#define CLPV_DO(i) r.c##i = a.c##i + b.c##i;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return r;
}

// a + s b
CLPV_INLINE Coefficients add_scaled(const Coefficients a, const Coefficient s, const Coefficients b) {
  Coefficients r;
#define CLPV_DO(i) r.c##i = fma(s, b.c##i, a.c##i);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return r;
}

CLPV_INLINE Coefficient dot_coefficients(const Coefficients a, const Coefficients b) {
  Coefficient r = 0.0f;
#define CLPV_DO(i) r = fma(a.c##i, b.c##i, r);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return r;
}

#endif
