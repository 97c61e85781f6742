// SPDX-License-Identifier: MIT
// Completes the harmonics of a cell's light to a clamped cosine (docs/method.md, 'The sweep';
// host/basis/sweep.hpp). From the host: CLPV_COSINE_E0, E2, E4, the e_0, e_2, e_4 below.
#pragma once

#include "sweep/sweep_layout.h"

#if CLPV_COSINE_REST
#define CLPV_ALPHA_0 0.886226925f  // sqrt(pi) / 2: integral of a clamped cosine times Y_0
#define CLPV_ALPHA_1 1.02332671f   // sqrt(pi / 3): length of its integrals with band 1
#define CLPV_Y_1 0.488602512f      // largest value of a function of band 1

// Adds what harmonics lack of a clamped cosine about the normal n of the cells' light, the
// direction of band 1:
//
//   I_w += r^4 c_0 / alpha_0 (|z| / 2 - e_0 - e_2 z^2 - e_4 z^4),   z = w . n
//   r = min(1, (|c_1| / |alpha_1|) / (c_0 / alpha_0))
//
// r is 1 where all light leaves about n, and less where normals differ; nothing is added without
// light or direction. `source`: c_0 of a channel.
CLPV_INLINE void add_cosine_rest(__constant const float* means, CLPV_BUFFER_IN source, const int at,
                                 realW injected[CLPV_PARTS]) {
  const realW uniform = read_numbers(source, at);
  realW z[CLPV_PARTS], square = ZERO;
#pragma unroll
  for (int part = 0; part < CLPV_PARTS; ++part) z[part] = ZERO;
  for (int j = 1; j < 4; ++j) {
    const realW c = read_numbers(source + j * CLPV_SWEEP_VOLUME, at);
    square = fma(c, c, square);
#pragma unroll
    for (int part = 0; part < CLPV_PARTS; ++part)
      z[part] = fma((realW)(means[part * CLPV_EMITTING + j]), c, z[part]);
  }
  const intW directed = (square > ZERO) & (uniform > ZERO);
  const realW linear = sqrt(directed ? square : ONE);
  realW r = CLPV_ALPHA_0 / CLPV_ALPHA_1 * linear / (directed ? uniform : ONE);
  r = r < ONE ? r : ONE;
  const realW amplitude = directed ? r * r * (r * r) * uniform * (1.0f / CLPV_ALPHA_0) : ZERO;
  const realW scale = 1.0f / (CLPV_Y_1 * linear);
#pragma unroll
  for (int part = 0; part < CLPV_PARTS; ++part) {
    const realW along = z[part] * scale, squared = along * along;
    const realW lacking = 0.5f * fabs(along) -
                          (CLPV_COSINE_E0 + squared * (CLPV_COSINE_E2 + squared * CLPV_COSINE_E4));
    injected[part] = fma(amplitude, lacking, injected[part]);
  }
}
#endif
