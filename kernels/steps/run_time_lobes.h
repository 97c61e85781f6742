// SPDX-License-Identifier: MIT
// Propagation step with lobes computed at run time, at the cost of the paper's Table 1
// (docs/paper/table1.md).
//
//   c += sum_f (F_f / pi) A^-1 alpha(n_f),   F_f the flux through face f, n_f its normal
//
// Each face rotates (or projects) a lobe to its normal, once for all channels. With
// CLPV_EVALUATE_AT_RUN_TIME the flux, too, uses basis functions evaluated along the link. Normals
// and links are read from memory, so that compilers cannot fold them; look-up tables are arguments.
// From the host: CLPV_UNIT_FLUX, CLPV_EVALUATE_AT_RUN_TIME, functions_of_link(link), the functions
// times the solid angle, and the text of host/codegen/inject_source.hpp.
#pragma once

#include "inject/lobe.h"

// Coefficients of a lobe of 1 W about a normal.
CLPV_INLINE Coefficients run_time_lobe(const float4 normal CLPV_AND_TABLE) {
  const Coefficients alpha = lobe_integrals(normal.x, normal.y, normal.z CLPV_PASS_TABLE);
#if CLPV_UNIT_FLUX
  const float scale = 1.0f / lobe_flux(alpha);
#else
  const float scale = M_1_PI_F;
#endif
  return project_sum(scale_coefficients(scale, alpha));
}

// Light that cell (x, y, z) gains from its six neighbours in each channel: first all fluxes, then
// the lobes of all faces.
CLPV_INLINE void gain_with_lobes(CLPV_VOLUME_IN source, const int x, const int y, const int z,
                                 __global const float4* normals, __global const float4* links,
                                 Coefficients* gained
#if CLPV_BLOCKING
                                 ,
                                 const Links t
#endif
                                     CLPV_AND_TABLE CLPV_AND_FUNCTIONS) {
#if CLPV_EVALUATE_AT_RUN_TIME
  Coefficients along[CLPV_AXES * CLPV_SEEN_FACES];
  for (int face = 0; face < CLPV_AXES * CLPV_SEEN_FACES; ++face)
    along[face] = functions_of_link(links[face] CLPV_PASS_FUNCTIONS);
#endif
  float fluxes[3][CLPV_AXES * CLPV_SEEN_FACES];
#pragma unroll
  for (int channel = 0; channel < 3; ++channel) {
#pragma unroll
    for (int k = 0; k < CLPV_AXES; ++k) {
      const Coefficients from = load_upstream(source, channel, k, x, y, z);
#if !CLPV_EVALUATE_AT_RUN_TIME
      const SeenFaces half_flux = half_fluxes_to(k, from);
#endif
#pragma unroll
      for (int f = 0; f < CLPV_SEEN_FACES; ++f) {
        const int face = CLPV_SEEN_FACES * k + f;
#if CLPV_EVALUATE_AT_RUN_TIME
        fluxes[channel][face] = fmax(dot_coefficients(along[face], from), 0.0f);
#else
        fluxes[channel][face] = positive_flux(half_flux.face[f]);
#endif
#if CLPV_BLOCKING
        fluxes[channel][face] *= t.c[face];
#endif
      }
    }
  }
  for (int channel = 0; channel < 3; ++channel) gained[channel] = zero_coefficients();
  for (int face = 0; face < CLPV_AXES * CLPV_SEEN_FACES; ++face) {
    const Coefficients lobe = run_time_lobe(normals[face] CLPV_PASS_TABLE);
#pragma unroll
    for (int channel = 0; channel < 3; ++channel)
      gained[channel] = add_scaled(gained[channel], fluxes[channel][face], lobe);
  }
}
