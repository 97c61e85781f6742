// SPDX-License-Identifier: MIT
// Computes the reflectance of each face of each light cell from the sums of reflectors.cl: coverage
// times mean albedo.
//
//   R_a = c_a A_a prod_b (1 - loss c_b),   b: the four faces adjacent to a      (docs/method.md,
//                                                                               'More bounces')
//
// c is the covered share of a face's samples, A the mean albedo. Overlapping triangles count once,
// so that no face reflects more than it receives. A sweep transports light through the edge between
// two faces once, and incident flux counts it on both: the loss corrects that (CLPV_EDGE_LOSS,
// host/basis/bounce.hpp).
//
// In:   faces       sums per face (shared/reflectors.h)
// Out:  reflectors  R in [0, 1], six numbers per cell and channel, in the order of
//                   shared/reflectors.h
// A work-item computes a cell.
#include "volume/coefficients.h"
#include "shared/reflectors.h"
#include "volume/light.h"

static inline float face_coverage(__global const uint* face) {
  return (float)(popcount(face[0]) + popcount(face[1])) * (1.0f / 64.0f);
}

__kernel void face_albedo(__global const uint* faces, CLPV_VOLUME_OUT reflectors) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  __global const uint* cell =
      faces + (size_t)((z * CLPV_GRID + y) * CLPV_GRID + x) * (CLPV_CELL_FACES * CLPV_FACE_WORDS);
  float remaining[3];  // factor of the two faces across each axis on faces along the other two
  for (int axis = 0; axis < 3; ++axis) {
    __global const uint* up = cell + 2 * axis * CLPV_FACE_WORDS;
    remaining[axis] = (1.0f - CLPV_EDGE_LOSS * face_coverage(up)) *
                      (1.0f - CLPV_EDGE_LOSS * face_coverage(up + CLPV_FACE_WORDS));
  }
  Coefficients red, green, blue;
#pragma unroll
  for (int i = 0; i < CLPV_CELL_FACES; ++i) {
    __global const uint* face = cell + i * CLPV_FACE_WORDS;
    const float coverage =
        face_coverage(face) * remaining[(i / 2 + 1) % 3] * remaining[(i / 2 + 2) % 3];
    const float per_sample = 1.0f / (CLPV_ALBEDO_UNIT * (float)max(face[CLPV_FACE_SAMPLES], 1u));
    red.c[i] = coverage * fmin(per_sample * (float)face[CLPV_FACE_ALBEDO], 1.0f);
    green.c[i] = coverage * fmin(per_sample * (float)face[CLPV_FACE_ALBEDO + 1], 1.0f);
    blue.c[i] = coverage * fmin(per_sample * (float)face[CLPV_FACE_ALBEDO + 2], 1.0f);
  }
  light_store(reflectors, 0, x, y, z, red);
  light_store(reflectors, 1, x, y, z, green);
  light_store(reflectors, 2, x, y, z, blue);
}
