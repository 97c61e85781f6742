// SPDX-License-Identifier: MIT
// The paper's lobes (its Appendix 2; docs/paper/lobes.md sets both side by side): the lobe about +z
// is projected once, and rotated to the axis n.
//
//   c(n) = A^-1 R c_z,   R_ij = H_ij(xi_i . Rot xi_j),   c_z = A^-1 alpha(z)
//
// Rot turns +z to n; H_ij(t) = 4 pi G(t; lambda_i lambda_j) is read from a table. A^-1 occurs
// twice: the host applies it to alpha(z), project_sum() to R c_z (lobe.h).
//
// From the host: CLPV_UP_LOBE, c_z; CLPV_SINGULAR_PARTS, the part of the table of H for each pair
// of functions.
#pragma once

#include "basis/table.h"

__constant const float up_lobe[CLPV_N] = CLPV_UP_LOBE;
__constant const int singular_parts[CLPV_N * CLPV_N] = CLPV_SINGULAR_PARTS;

// Smallest rotation of +z to a unit vector n; for -z a half turn about x. Rows
//   xx  xy  n.x
//   xy  yy  n.y
// -n.x -n.y  n.z
typedef struct {
  float xx, xy, yy, x, y, z;
} Rotation;

CLPV_INLINE Rotation rotation_to(const float x, const float y, const float z) {
  const float square = fma(x, x, y * y);
  const float k = z < 0.0f ? (1.0f - z) / square : 1.0f / (1.0f + z);
  const int down = z < 0.0f && square == 0.0f;
  const Rotation r = {down ? 1.0f : fma(k * y, y, z), down ? 0.0f : -k * x * y,
                      down ? -1.0f : fma(k * x, x, z), x, y, z};
  return r;
}

// row . centre, without products of zeros.
CLPV_INLINE float row_product(__constant const float* centre, const float a, const float b,
                              const float c) {
  float sum = 0.0f;
  if (centre[2] != 0.0f) sum = centre[2] * c;
  if (centre[1] != 0.0f) sum = fma(centre[1], b, sum);
  if (centre[0] != 0.0f) sum = fma(centre[0], a, sum);
  return sum;
}

// R c_z: the integrals of b_i times the lobe about the unit vector n = (x, y, z).
CLPV_INLINE Coefficients rotated_integrals(const float x, const float y, const float z,
                                           CLPV_TABLE singular_table) {
  const Rotation to = rotation_to(x, y, z);
  Coefficients cx, cy, cz;  // rotated centres
#pragma unroll
  for (int j = 0; j < CLPV_N; ++j) {
    cx.c[j] = row_product(centres[j], to.xx, to.xy, to.x);
    cy.c[j] = row_product(centres[j], to.xy, to.yy, to.y);
    cz.c[j] = row_product(centres[j], -to.x, -to.y, to.z);
  }
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) {
    float sum = 0.0f;
#pragma unroll
    for (int j = 0; j < CLPV_N; ++j) {
      const float t = rounded_dot(centres[i], cx.c[j], cy.c[j], cz.c[j]);
      sum = fma(up_lobe[j], read_table(singular_table, singular_parts[i * CLPV_N + j], t), sum);
    }
    r.c[i] = sum;
  }
  return r;
}
