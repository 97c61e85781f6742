// SPDX-License-Identifier: MIT
// Flux that a neighbour sends through the faces of a cell that it sees, from the neighbour's
// coefficients.
//
//   F = Omega_f I(w_f) = sum_i c_i Omega_f b_i(w_f)
//
// From the host (host/pipeline/steps/propagate.cpp): CLPV_FACE_FLUX, Omega_f b_i(w_f) for each face
// and function of the basis.
#pragma once

#include "steps/faces.h"

__constant const float face_flux[CLPV_FACES][CLPV_N] = CLPV_FACE_FLUX;

typedef struct {
  realW face[CLPV_SEEN_FACES];
} SeenFaces;

// Omega_f I(w_f) [W] for the five faces of this cell that the neighbour `from` sees, whose light
// travels along axis k. One function at a time, so that five sums grow side by side.
CLPV_INLINE SeenFaces fluxes_to(const int k, const Coefficients from) {
  SeenFaces flux;
#pragma unroll
  for (int f = 0; f < CLPV_SEEN_FACES; ++f) flux.face[f] = 0.0f;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) {
#pragma unroll
    for (int f = 0; f < CLPV_SEEN_FACES; ++f) {
      const float share = face_flux[CLPV_SEEN_FACES * k + f][i];
      if (share != 0.0f) flux.face[f] = fma((realW)(share), from.c[i], flux.face[f]);
    }
  }
  return flux;
}

// max(0, F) without a comparison, which would trigger LLVM's SLP vectoriser and prevent that of
// work-items: with one lane PoCL 3.1 took 12 times as long.
CLPV_INLINE realW positive_flux(const realW flux) {
  return 0.5f * (flux + fabs(flux));
}
