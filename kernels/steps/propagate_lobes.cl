// SPDX-License-Identifier: MIT
// The step of propagate.cl with lobes computed at run time, at the cost of the paper's Table 1
// (docs/paper/table1.md). Slow, with the same result.
//
//   c += sum_f (F_f / pi) A^-1 alpha(n_f),   F_f the flux through face f, n_f its normal
//
// Each face rotates (or projects) a lobe to its normal, once for all channels. With
// CLPV_EVALUATE_AT_RUN_TIME 1 the flux, too, uses basis functions evaluated along the link, F_f =
// max(0, sum_i c_i Omega_f b_i(w_f)) T_f; else integrals over faces are constants (face_flux.h).
//
// In:   source, sum_so_far, transmittance, least   as in propagate.cl
//       normals   n_f of each face
//       links     direction w_f of the link through each face, and the face's solid angle Omega_f
//       tables of H and G (basis/table.h), if lobes are rotated and functions looked up
// Out:  target, sum   as in propagate.cl
// A work-item computes one cell in all channels. Normals and links are read from memory, so that
// compilers cannot fold them.
//
// From the host (host/pipeline/steps/propagate.cpp): CLPV_EVALUATE_AT_RUN_TIME; CLPV_UNIT_FLUX
// 1: lobes are scaled to the exact flux; and the literals of face_flux.h and basis/lobe.h.
#include "basis/lobe.h"
#include "steps/face_flux.h"
#include "volume/whole_groups.h"

// Coefficients of a lobe of 1 W about a normal.
CLPV_INLINE Coefficients lobe_about(const float4 normal CLPV_AND_H) {
  const Coefficients alpha = lobe_integrals(normal.x, normal.y, normal.z CLPV_PASS_H);
  const float scale = CLPV_UNIT_FLUX ? 1.0f / lobe_flux(alpha) : M_1_PI_F;
  return project_sum(scale_coefficients(scale, alpha));
}

// Omega_f b_i(w_f)
CLPV_INLINE Coefficients functions_of_link(const float4 link CLPV_AND_G) {
  return scale_coefficients(link.w, functions_at(link.x, link.y, link.z CLPV_PASS_G));
}

typedef struct {
  float face[CLPV_FACES];
} Fluxes;

// max(0, Omega_f I(w_f)) T_f of each face and channel.
CLPV_INLINE void find_fluxes(CLPV_VOLUME_IN source, const int x, const int y, const int z,
                             const Links t, __global const float4* links,
                             Fluxes fluxes[3] CLPV_AND_G) {
  Coefficients along[CLPV_FACES];
  for (int face = 0; face < CLPV_FACES && CLPV_EVALUATE_AT_RUN_TIME; ++face)
    along[face] = functions_of_link(links[face] CLPV_PASS_G);
#pragma unroll
  for (int channel = 0; channel < 3; ++channel) {
#pragma unroll
    for (int k = 0; k < CLPV_AXES; ++k) {
      const Coefficients from = load_upstream(source, channel, k, x, y, z);
#if CLPV_EVALUATE_AT_RUN_TIME
      SeenFaces flux;
#pragma unroll
      for (int f = 0; f < CLPV_SEEN_FACES; ++f)
        flux.face[f] = dot_coefficients(along[CLPV_SEEN_FACES * k + f], from);
#else
      const SeenFaces flux = fluxes_to(k, from);
#endif
#pragma unroll
      for (int f = 0; f < CLPV_SEEN_FACES; ++f) {
        const int face = CLPV_SEEN_FACES * k + f;
        fluxes[channel].face[face] = positive_flux(flux.face[f]) * t.c[face];
      }
    }
  }
}

__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, 1, 1))) void propagate_lobes(
    CLPV_VOLUME_IN source, CLPV_VOLUME_OUT target, CLPV_VOLUME_IN sum_so_far,
    CLPV_VOLUME_OUT sum CLPV_AND_TRANSMITTANCE, __global const float4* normals,
    __global const float4* links CLPV_AND_H CLPV_AND_G) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  if (outside_grid(x, y)) return;
  const Links t = face_transmittances(x, y, z CLPV_PASS_TRANSMITTANCE);
  Fluxes fluxes[3];
  find_fluxes(source, x, y, z, t, links, fluxes CLPV_PASS_G);
  Coefficients gained[3];
  for (int channel = 0; channel < 3; ++channel) gained[channel] = zero_coefficients();
  for (int face = 0; face < CLPV_FACES; ++face) {
    const Coefficients lobe = lobe_about(normals[face] CLPV_PASS_H);
#pragma unroll
    for (int channel = 0; channel < 3; ++channel)
      gained[channel] = add_scaled(gained[channel], fluxes[channel].face[face], lobe);
  }
  // Without a loop, in which rusticl loses structs passed by value (lab/docs/rusticl.md).
  store_step(gained[0], target, sum_so_far, sum, 0, x, y, z);
  store_step(gained[1], target, sum_so_far, sum, 1, x, y, z);
  store_step(gained[2], target, sum_so_far, sum, 2, x, y, z);
}
