// SPDX-License-Identifier: MIT
// Completes the harmonics of a cell's light to a clamped cosine (docs/method.md, 'The sweep';
// host/basis/sweep.hpp). From the host: CLPV_COSINE_E0, E2, E4, the e_0, e_2, e_4 below.
#pragma once

#include "sweep/sweep_layout.h"

#if CLPV_COSINE_REST
#define CLPV_ALPHA_0 0.886226925f  // sqrt(pi) / 2: integral of a clamped cosine times Y_0
#define CLPV_ALPHA_1 1.02332671f   // sqrt(pi / 3): length of its integrals with band 1
#define CLPV_Y_1 0.488602512f      // largest value of a function of band 1

// Adds what harmonics lack of a clamped cosine about the normal n of a cell's light, the direction
// of band 1 of all channels together, per c_0 of a channel:
//
//   I_w += r^4 c_0 / alpha_0 (|z| / 2 - e_0 - e_2 z^2 - e_4 z^4),   z = w . n
//   r = min(1, (|c_1| / |alpha_1|) / (c_0 / alpha_0))   c: sum of all channels
//
// r is 1 where all light leaves about n, and less where normals differ; nothing is added without
// light or direction. `source`: c_0 of the first channel.
CLPV_INLINE void find_cosine_rest(__constant const float* means, CLPV_BUFFER_IN source,
                                  const int at, realW lacking[CLPV_PARTS]) {
  realW c[4], square = ZERO;
#pragma unroll
  for (int j = 0; j < 4; ++j) {
    CLPV_BUFFER_IN volume = source + j * CLPV_SWEEP_VOLUME;
    c[j] = read_numbers(volume, at) +
           read_numbers(volume + CLPV_SOURCES * CLPV_SWEEP_VOLUME, at) +
           read_numbers(volume + 2 * CLPV_SOURCES * CLPV_SWEEP_VOLUME, at);
    if (j > 0) square = fma(c[j], c[j], square);
  }
  const intW directed = (square > ZERO) & (c[0] > ZERO);
  const realW linear = sqrt(directed ? square : ONE);
  realW r = CLPV_ALPHA_0 / CLPV_ALPHA_1 * linear / (directed ? c[0] : ONE);
  r = r < ONE ? r : ONE;
  const realW amplitude = directed ? r * r * (r * r) * (1.0f / CLPV_ALPHA_0) : ZERO;
  const realW scale = 1.0f / (CLPV_Y_1 * linear);
#pragma unroll
  for (int part = 0; part < CLPV_PARTS; ++part) {
    realW z = ZERO;
    for (int j = 1; j < 4; ++j) z = fma((realW)(means[part * CLPV_EMITTING + j]), c[j], z);
    const realW along = z * scale, squared = along * along;
    lacking[part] =
        amplitude * (0.5f * fabs(along) -
                     (CLPV_COSINE_E0 + squared * (CLPV_COSINE_E2 + squared * CLPV_COSINE_E4)));
  }
}
#endif
