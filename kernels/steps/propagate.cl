// SPDX-License-Identifier: MIT
// Propagates light by one step, into every cell from its six neighbours, and adds it to the sum of
// all steps.
//
//   F = max(0, Omega_f I(w_f)) T_f      for the five visible faces f of each neighbour
//   I(w) = sum_i c_i b_i(w)
//   c += (F / pi) c(n_f)
//
// Kaplanyan and Dachsbacher 2010, 'Cascaded light propagation volumes'; docs/method.md,
// 'Propagation'.
//
// In:   source         light of the previous step (the injected field at first) [W/sr]
//       sum_so_far     sum of the previous steps, which may be the same memory as `sum`
//       transmittance  with CLPV_BLOCKING: T of each link into a cell (transmittance.cl)
//       least          with CLPV_BLOCKING: lower bound of T: 1 in the first step, which is not
//                      blocked, else 0
// Out:  target         light of this step [W/sr]
//       sum            sum_so_far + target
// A work-item computes W cells of a row in one channel, or in all three with
// CLPV_LOBES_AT_RUN_TIME.
//
// From the host (host/codegen/transport_source.cpp), for face 5 k + f of the neighbour that light
// reaches along axis k, axes in the order +x, -x, +y, -y, +z, -z:
//   CLPV_FACE_FLUX     half of Omega_f b_i(w_f) for each function of the basis
//   CLPV_FACE_NORMAL   axis of the face's outward normal
//   CLPV_LOBES         c(n) / pi for a normal along each axis
#include "volume/coefficients.h"
#include "volume/whole_groups.h"
#include "volume/light.h"
#if CLPV_BLOCKING
#include "volume/transmittance.h"
#endif

enum {
  CLPV_AXES = 6,
  CLPV_SEEN_FACES = 5,  // of a neighbour
};

__constant const float face_flux[CLPV_AXES * CLPV_SEEN_FACES][CLPV_N] = CLPV_FACE_FLUX;
__constant const int face_normal[CLPV_AXES * CLPV_SEEN_FACES] = CLPV_FACE_NORMAL;
__constant const float lobes[CLPV_AXES][CLPV_N] = CLPV_LOBES;

// Loads the cell that light reaches cell (x, y, z) from along axis k.
CLPV_INLINE Coefficients load_upstream(CLPV_VOLUME_IN source, const int channel, const int k,
                                       const int x, const int y, const int z) {
  const int back = k % 2 == 0 ? -1 : 1;
  return light_load(source, channel, x + (k / 2 == 0 ? back : 0), y + (k / 2 == 1 ? back : 0),
                    z + (k / 2 == 2 ? back : 0));
}

typedef struct {
  realW face[CLPV_SEEN_FACES];
} SeenFaces;

// Half of Omega_f I(w_f) [W] for the five faces that a cell sees of the neighbour along axis k. One
// function at a time, so that five sums grow side by side.
CLPV_INLINE SeenFaces half_fluxes_to(const int k, const Coefficients from) {
  SeenFaces half_flux;
#pragma unroll
  for (int f = 0; f < CLPV_SEEN_FACES; ++f) half_flux.face[f] = 0.0f;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) {
#pragma unroll
    for (int f = 0; f < CLPV_SEEN_FACES; ++f) {
      const float share = face_flux[CLPV_SEEN_FACES * k + f][i];
      if (share != 0.0f) half_flux.face[f] = fma((realW)(share), from.c[i], half_flux.face[f]);
    }
  }
  return half_flux;
}

// max(0, 2 h) without a comparison, which would trigger LLVM's SLP vectoriser and prevent that of
// work-items.
CLPV_INLINE realW positive_flux(const realW half_flux) {
  return half_flux + fabs(half_flux);
}

#ifndef CLPV_LOBES_AT_RUN_TIME
#define CLPV_LOBES_AT_RUN_TIME 0
#endif
#if CLPV_LOBES_AT_RUN_TIME
#include "steps/run_time_lobes.h"
#else

// Light that cell (x, y, z) gains from its six neighbours. `t`: transmittance of the link to each
// face.
CLPV_INLINE Coefficients gain_light(CLPV_VOLUME_IN source, const int channel, const int x,
                                    const int y, const int z
#if CLPV_BLOCKING
                                    ,
                                    const Links t
#endif
) {
  realW arriving[CLPV_AXES];  // flux [W] through the faces with a normal along each axis
#pragma unroll
  for (int n = 0; n < CLPV_AXES; ++n) arriving[n] = 0.0f;
#pragma unroll
  for (int k = 0; k < CLPV_AXES; ++k) {
    const SeenFaces half_flux = half_fluxes_to(k, load_upstream(source, channel, k, x, y, z));
#pragma unroll
    for (int f = 0; f < CLPV_SEEN_FACES; ++f) {
      const int face = CLPV_SEEN_FACES * k + f;
#if CLPV_BLOCKING
      arriving[face_normal[face]] += positive_flux(half_flux.face[f]) * t.c[face];
#else
      arriving[face_normal[face]] += positive_flux(half_flux.face[f]);
#endif
    }
  }
  Coefficients gained = zero_coefficients();
#pragma unroll
  for (int n = 0; n < CLPV_AXES; ++n) gained = add_row(gained, arriving[n], lobes[n]);
  return gained;
}
#endif

CLPV_INLINE void store_step(const Coefficients gained, CLPV_VOLUME_OUT target,
                            CLPV_VOLUME_IN sum_so_far, CLPV_VOLUME_OUT sum, const int channel,
                            const int x, const int y, const int z) {
  light_store(target, channel, x, y, z, gained);
  light_store(sum, channel, x, y, z,
              add_coefficients(light_load(sum_so_far, channel, x, y, z), gained));
}

__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, 1, 1))) void propagate_step(
    CLPV_VOLUME_IN source, CLPV_VOLUME_OUT target, CLPV_VOLUME_IN sum_so_far, CLPV_VOLUME_OUT sum
#if CLPV_BLOCKING
    , CLPV_VOLUME_IN transmittance, const float least
#endif
#if CLPV_LOBES_AT_RUN_TIME
    , __global const float4* normals, __global const float4* links CLPV_AND_TABLE CLPV_AND_FUNCTIONS
#endif
) {
  const int x = W * (int)get_global_id(0), y = (int)get_global_id(1),
            z = (int)get_global_id(2) % CLPV_GRID;
  CLPV_RETURN_OUTSIDE(x, y);
#if CLPV_BLOCKING
  Links t = transmittance_load(transmittance, 0, x, y, z);
#pragma unroll
  for (int face = 0; face < CLPV_AXES * CLPV_SEEN_FACES; ++face)
    t.c[face] = max(t.c[face], (realW)(least));
#define CLPV_PASS_LINKS , t
#else
#define CLPV_PASS_LINKS
#endif
#if CLPV_LOBES_AT_RUN_TIME
  Coefficients gained[3];
  gain_with_lobes(source, x, y, z, normals, links,
                  gained CLPV_PASS_LINKS CLPV_PASS_TABLE CLPV_PASS_FUNCTIONS);
  for (int channel = 0; channel < 3; ++channel)
    store_step(gained[channel], target, sum_so_far, sum, channel, x, y, z);
#else
  const int channel = (int)get_global_id(2) / CLPV_GRID;
  store_step(gain_light(source, channel, x, y, z CLPV_PASS_LINKS), target, sum_so_far, sum, channel,
             x, y, z);
#endif
}
