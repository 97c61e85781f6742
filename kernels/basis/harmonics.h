// SPDX-License-Identifier: MIT
// Real spherical harmonics of bands l = 0 .. CLPV_BANDS - 1, orders m = -l .. l, in the order
// i = l^2 + l + m.
//
//   Y_lm(w) = Re or Im (x + i y)^|m| K_lm Q_lm(z)     Re for m >= 0, Im for m < 0
//   alpha_lm(n) = A_l Y_lm(n)
//
// Q_lm is even or odd in z: a polynomial in z^2, times z if l - |m| is odd
// (host/basis/bases.cpp).
//
// From the host: CLPV_BANDS; CLPV_Y and CLPV_COSINE_Y, the coefficients of z^0, z^2, ... of K_lm
// Q_lm without the factor z, and A_l times them. Functions of bands that the cosine lacks (A_l 0)
// have zeros.
#pragma once

enum { CLPV_Y_TERMS = (CLPV_BANDS + 1) / 2 };

__constant const float harmonics_y[CLPV_N][CLPV_Y_TERMS] = CLPV_Y;
__constant const float cosine_y[CLPV_N][CLPV_Y_TERMS] = CLPV_COSINE_Y;

// (x + i y)^m for m = 0 .. CLPV_BANDS - 1.
typedef struct {
  float re[CLPV_BANDS], im[CLPV_BANDS];
} Powers;

CLPV_INLINE Powers powers_of(const float x, const float y) {
  Powers p;
  p.re[0] = 1.0f, p.im[0] = 0.0f;
  p.re[1] = x, p.im[1] = y;
#pragma unroll
  for (int m = 2; m < CLPV_BANDS; ++m) {
    p.re[m] = fma(x, p.re[m - 1], -(y * p.im[m - 1]));
    p.im[m] = fma(x, p.im[m - 1], y * p.re[m - 1]);
  }
  return p;
}

// Sum of row[k] zz^k for k up to `last`, in Horner's form; 0 for a row of zeros.
CLPV_INLINE float even_polynomial(__constant const float* row, const int last, const float zz) {
  float sum = row[last];
  if (sum == 0.0f) return 0.0f;
#pragma unroll
  for (int k = last - 1; k >= 0; --k) sum = fma(zz, sum, row[k]);
  return sum;
}

CLPV_INLINE Coefficients sum_harmonics(__constant const float (*table)[CLPV_Y_TERMS], const float x,
                                       const float y, const float z) {
  const Powers p = powers_of(x, y);
  const float zz = z * z;
  Coefficients r;
#pragma unroll
  for (int l = 0; l < CLPV_BANDS; ++l) {
#pragma unroll
    for (int m = -l; m <= l; ++m) {
      const int order = m < 0 ? -m : m, i = l * l + l + m;
      const float around = m < 0 ? p.im[order] : p.re[order];
      const float odd = (l - order) % 2 == 1 ? z : 1.0f;
      r.c[i] = around * odd * even_polynomial(table[i], (l - order) / 2, zz);
    }
  }
  return r;
}

CLPV_INLINE Coefficients basis_functions(const float x, const float y, const float z) {
  return sum_harmonics(harmonics_y, x, y, z);
}

CLPV_INLINE Coefficients cosine_integrals(const float x, const float y, const float z) {
  return sum_harmonics(cosine_y, x, y, z);
}
