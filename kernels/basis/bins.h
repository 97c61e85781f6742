// SPDX-License-Identifier: MIT
// Direction bins: each face of a cube about the origin has CLPV_SIDE x CLPV_SIDE regions, and b_i
// is 1 in region i and 0 elsewhere. On a boundary adjacent bins have equal shares.
//
//   alpha_i(n) = sum of a_p over the patches p of bin i
//   a_p = Int_p max(0, w . n) dw, exact for patches that the horizon of n does not cross
//
// A face with normal axis k has u along axis k + 1 and v along k + 2; lines between its regions are
// u = l n and v = l n, n the coordinate along the normal. docs/bases.md.
//
// From the host: CLPV_SIDE; CLPV_LINES, the side - 1 numbers l; CLPV_BIN_PATCHES patches of each
// bin. Row p of these tables has patch p of every bin:
//   CLPV_PATCH_X, CLPV_PATCH_Y, CLPV_PATCH_Z   Int_p w dw
//   CLPV_PATCH_WIDTH, CLPV_PATCH_PER_WIDTH     width times solid angle, and its inverse: the
//                                              horizon crosses a patch if |a| < width / 2
#pragma once

__constant const float lines[CLPV_SIDE - 1] = CLPV_LINES;
__constant const float patch_x[CLPV_BIN_PATCHES][CLPV_N] = CLPV_PATCH_X;
__constant const float patch_y[CLPV_BIN_PATCHES][CLPV_N] = CLPV_PATCH_Y;
__constant const float patch_z[CLPV_BIN_PATCHES][CLPV_N] = CLPV_PATCH_Z;
__constant const float patch_width[CLPV_BIN_PATCHES][CLPV_N] = CLPV_PATCH_WIDTH;
__constant const float patch_per_width[CLPV_BIN_PATCHES][CLPV_N] = CLPV_PATCH_PER_WIDTH;

// 1 for s > 0, 0 for s < 0, 1/2 on the boundary.
CLPV_INLINE float unit_step(const float s) { return fma(0.5f, sign(s), 0.5f); }

// Share of region i at coordinate t along u or v of a face; n: coordinate along its normal.
CLPV_INLINE float region_share(const int i, const float n, const float t) {
  const float above = i == 0 ? 1.0f : unit_step(fma(-lines[max(i - 1, 0)], n, t));
  return i + 1 == CLPV_SIDE ? above
                            : above - unit_step(fma(-lines[min(i, CLPV_SIDE - 2)], n, t));
}

CLPV_INLINE Coefficients basis_functions(const float x, const float y, const float z) {
  const float w[3] = {x, y, z};
  float of_face[6], sum = 0.0f;  // sum of the six faces: 1, or 3/4 towards a corner of the cube
#pragma unroll
  for (int face = 0; face < 6; ++face) {
    const int k = face / 2;
    const float n = face % 2 == 0 ? w[k] : -w[k];
    of_face[face] = unit_step(n - fabs(w[(k + 1) % 3])) * unit_step(n - fabs(w[(k + 2) % 3]));
    sum += of_face[face];
  }
  const float whole = 1.0f / sum;
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) {
    const int face = i / (CLPV_SIDE * CLPV_SIDE), k = face / 2;
    const float n = face % 2 == 0 ? w[k] : -w[k];
    r.c[i] = of_face[face] * whole * region_share(i % CLPV_SIDE, n, w[(k + 1) % 3]) *
             region_share(i / CLPV_SIDE % CLPV_SIDE, n, w[(k + 2) % 3]);
  }
  return r;
}

// Eight bins at a time: scalar code would take most of injection's time.
enum { CLPV_BIN_EIGHTS = CLPV_N / 8 };

CLPV_INLINE float8 eight_of(__constant const float* row, const int group) {
  return vload8(group, row);
}

CLPV_INLINE Coefficients cosine_integrals(const float x, const float y, const float z) {
  const float8 none = (float8)(0.0f), whole = (float8)(1.0f);
  float8 part[CLPV_BIN_EIGHTS], all = none;
#pragma unroll
  for (int g = 0; g < CLPV_BIN_EIGHTS; ++g) part[g] = none;
#pragma unroll
  for (int p = 0; p < CLPV_BIN_PATCHES; ++p) {
#pragma unroll
    for (int g = 0; g < CLPV_BIN_EIGHTS; ++g) {
      const float8 a = eight_of(patch_x[p], g) * x + eight_of(patch_y[p], g) * y +
                       eight_of(patch_z[p], g) * z;
      const float8 half_width = 0.5f * eight_of(patch_width[p], g);
      const float8 lit = clamp(a * eight_of(patch_per_width[p], g) + 0.5f, none, whole);
      part[g] += half_width * lit * lit + fmax(none, a - half_width);
    }
  }
#pragma unroll
  for (int g = 0; g < CLPV_BIN_EIGHTS; ++g) all += part[g];
  const float4 four = all.lo + all.hi;
  const float scale = M_PI_F / (four.x + four.y + four.z + four.w);
  Coefficients r;
#pragma unroll
  for (int g = 0; g < CLPV_BIN_EIGHTS; ++g) vstore8(part[g] * scale, g, r.c);
  return r;
}
