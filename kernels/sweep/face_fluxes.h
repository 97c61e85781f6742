// SPDX-License-Identifier: MIT
// Fluxes [W] on the six faces of W cells, in the order of shared/reflectors.h.
//
//   D_a = 0.956 sum_b Omega_b max(0, -w_b.a) L_b s^2, pi of even light 1
//                                                   (docs/method.md, 'More bounces')
//
// From the host (host/pipeline/sweep/sweep_literals.cpp): CLPV_INCIDENT, the weights of D_a for
// each face and bin.
#pragma once

#include "shared/reflectors.h"
#include "sweep/sweep_tiles.h"

typedef struct {
  realW c[CLPV_CELL_FACES];
} FaceFluxes;

__constant const float incident_weights[CLPV_CELL_FACES][CLPV_SWEEP_BINS] = CLPV_INCIDENT;

CLPV_INLINE FaceFluxes incident_flux(const Bins bins) {
  FaceFluxes flux;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a) {
    flux.c[a] = 0.0f;
#pragma unroll
    for (int b = 0; b < CLPV_SWEEP_BINS; ++b)
      if (incident_weights[a][b] != 0.0f)
        flux.c[a] = fma((realW)(incident_weights[a][b]), bins.c[b], flux.c[a]);
  }
  return flux;
}
