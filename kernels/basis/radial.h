// SPDX-License-Identifier: MIT
// Spherical radial basis functions (SRBF): Abel-Poisson kernels G about fixed centres xi_i, with
// bandwidths lambda_i.
//
//   b_i(w) = G(w . xi_i; lambda_i)
//   G(t; lambda) = (1 - lambda^2) / (1 - 2 lambda t + lambda^2)^(3/2)
//   alpha_i(n) = slope_i t + even_i(t),   t = n . xi_i
//
// alpha_i, the integral of b_i times the clamped cosine about n, depends on t only. Its odd part is
// linear in t, slope_i = 2 pi lambda_i; its even part is a series in t^2
// (host/basis/clamped_cosine.hpp). The singular integral H, which is
// the integral of two functions' product, is 4 pi G(xi_i . xi_j; lambda_i lambda_j): kernels read
// it from a table (rotated_lobe.h).
//
// From the host, for each function:
//   CLPV_CENTRES        xi_i
//   CLPV_OPPOSITES      index of an earlier function with centre -xi_i and equal lambda; i if there
//                       is none
//   CLPV_POISSON        1 - lambda^2, 1 + lambda^2, 2 lambda
//   CLPV_COSINE_SLOPE   slope_i
//   CLPV_COSINE_EVEN    even_i: CLPV_COSINE_TERMS coefficients of powers of t^2, or with
//                       CLPV_COSINE_CHEBYSHEV 1 those of Chebyshev polynomials of 2 t^2 - 1
#pragma once

__constant const float centres[CLPV_N][3] = CLPV_CENTRES;
__constant const int opposites[CLPV_N] = CLPV_OPPOSITES;
__constant const float poisson[CLPV_N][3] = CLPV_POISSON;
__constant const float cosine_slope[CLPV_N] = CLPV_COSINE_SLOPE;
__constant const float cosine_even[CLPV_N][CLPV_COSINE_TERMS] = CLPV_COSINE_EVEN;

// t_i = w . xi_i of every centre, without products of zeros.
CLPV_INLINE Coefficients centre_cosines(const float x, const float y, const float z) {
  const float w[3] = {x, y, z};
  Coefficients t;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) {
    float sum = 0.0f;
#pragma unroll
    for (int axis = 2; axis >= 0; --axis)
      if (centres[i][axis] != 0.0f) sum = fma(centres[i][axis], w[axis], sum);
    t.c[i] = opposites[i] < i ? -t.c[opposites[i]] : sum;
  }
  return t;
}

// G(t; lambda_i)
CLPV_INLINE float poisson_kernel(const int i, const float t) {
  const float d = rsqrt(fma(-poisson[i][2], t, poisson[i][1]));
  return poisson[i][0] * d * d * d;
}

CLPV_INLINE Coefficients basis_functions(const float x, const float y, const float z) {
  const Coefficients t = centre_cosines(x, y, z);
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) r.c[i] = poisson_kernel(i, t.c[i]);
  return r;
}

// even_i(t) by powers of t^2, in Horner's form.
CLPV_INLINE float even_by_powers(__constant const float* series, const float t) {
  const float square = t * t;
  float sum = series[CLPV_COSINE_TERMS - 1];
#pragma unroll
  for (int k = CLPV_COSINE_TERMS - 2; k >= 0; --k) sum = fma(square, sum, series[k]);
  return sum;
}

// even_i(t) by Chebyshev polynomials, in Clenshaw's recurrence, which is stable for any lambda.
CLPV_INLINE float even_by_chebyshev(__constant const float* series, const float t) {
  const float u = fma(4.0f * t, t, -2.0f);  // 2 (2 t^2 - 1)
  float next = 0.0f, after_next = 0.0f;
#pragma unroll
  for (int k = CLPV_COSINE_TERMS - 1; k > 0; --k) {
    const float sum = fma(u, next, series[k] - after_next);
    after_next = next;
    next = sum;
  }
  return fma(0.5f * u, next, series[0] - after_next);
}

CLPV_INLINE Coefficients cosine_integrals(const float x, const float y, const float z) {
  const Coefficients t = centre_cosines(x, y, z);
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) {
    const float even = CLPV_COSINE_CHEBYSHEV ? even_by_chebyshev(cosine_even[i], t.c[i])
                                             : even_by_powers(cosine_even[i], t.c[i]);
    r.c[i] = fma(cosine_slope[i], t.c[i], even);
  }
  return r;
}
