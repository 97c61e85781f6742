// SPDX-License-Identifier: MIT
// Computes the reflectance of each face of each light cell from the sums of reflectors.cl: coverage
// times mean albedo.
//
//   R_a = c_a A_a      (docs/method.md, 'More bounces')
//
// c is the covered share of a face's samples, A the mean of albedo times share. Overlapping
// triangles count once, so that no face reflects more than it receives.
//
// In:   faces       sums per face (shared/reflectors.h)
// Out:  reflectors  R in [0, 1], six numbers per cell and channel, in the order of
//                   shared/reflectors.h. Channel 3: mean share of each face's triangles, 0 on
//                   faces without one; channels 4 and 5: R of albedo 1
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
  for (int channel = 0; channel < CLPV_REFLECTOR_CHANNELS; ++channel) {
    const int sum = channel >= CLPV_REFLECTOR_SHARE ? CLPV_FACE_SHARE : CLPV_FACE_ALBEDO + channel;
    Coefficients c;
#pragma unroll
    for (int i = 0; i < CLPV_CELL_FACES; ++i) {
      __global const uint* face = cell + i * CLPV_FACE_WORDS;
      const float per_sample = 1.0f / (CLPV_ALBEDO_UNIT * (float)max(face[CLPV_FACE_SAMPLES], 1u)),
                  mean = fmin(per_sample * (float)face[sum], 1.0f);
      c.c[i] = channel == CLPV_REFLECTOR_SHARE ? mean : face_coverage(face) * mean;
    }
    light_store(reflectors, channel, x, y, z, c);
  }
}
