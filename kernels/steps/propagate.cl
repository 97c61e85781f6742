// SPDX-License-Identifier: MIT
// Propagates light by one step, into every cell from its six neighbours, and adds it to the sum of
// all steps.
//
//   F = max(0, Omega_f I(w_f)) T_f      for the five faces f of the cell that each neighbour sees
//   I(w) = sum_i c_i b_i(w)
//   c += (F / pi) c(n_f)
//
// Kaplanyan and Dachsbacher 2010, 'Cascaded light propagation volumes'; docs/method.md,
// 'Propagation'. propagate_lobes.cl computes c(n_f) for each face in place of reading it.
//
// In:   source         light of the previous step (the injected field at first) [W/sr]
//       sum_so_far     sum of the previous steps, which may be the same memory as `sum`
//       transmittance, least   with CLPV_BLOCKING: T of the links (faces.h)
// Out:  target         light of this step [W/sr]
//       sum            sum_so_far + target
// A work-item computes W cells of a row in one channel.
//
// From the host (host/pipeline/steps/propagate.cpp), faces and axes as in faces.h:
//   CLPV_FACE_FLUX     Omega_f b_i(w_f) (face_flux.h)
//   CLPV_FACE_NORMAL   axis of the face's outward normal
//   CLPV_LOBES         c(n) / pi for a normal along each axis
#include "steps/face_flux.h"
#include "volume/whole_groups.h"

__constant const int face_normal[CLPV_FACES] = CLPV_FACE_NORMAL;
__constant const float lobes[CLPV_AXES][CLPV_N] = CLPV_LOBES;

// Light that cell (x, y, z) gains from its six neighbours. `t`: transmittance of the link to each
// face.
CLPV_INLINE Coefficients gain_light(CLPV_VOLUME_IN source, const int channel, const int x,
                                    const int y, const int z, const Links t) {
  realW arriving[CLPV_AXES];  // flux [W] through the faces with a normal along each axis
#pragma unroll
  for (int n = 0; n < CLPV_AXES; ++n) arriving[n] = 0.0f;
#pragma unroll
  for (int k = 0; k < CLPV_AXES; ++k) {
    const SeenFaces flux = fluxes_to(k, load_upstream(source, channel, k, x, y, z));
#pragma unroll
    for (int f = 0; f < CLPV_SEEN_FACES; ++f) {
      const int face = CLPV_SEEN_FACES * k + f;
      arriving[face_normal[face]] += positive_flux(flux.face[f]) * t.c[face];
    }
  }
  Coefficients gained = zero_coefficients();
#pragma unroll
  for (int n = 0; n < CLPV_AXES; ++n) gained = add_row(gained, arriving[n], lobes[n]);
  return gained;
}

__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, 1, 1))) void propagate_step(
    CLPV_VOLUME_IN source, CLPV_VOLUME_OUT target, CLPV_VOLUME_IN sum_so_far,
    CLPV_VOLUME_OUT sum CLPV_AND_TRANSMITTANCE) {
  const int x = W * (int)get_global_id(0), y = (int)get_global_id(1),
            z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (outside_grid(x, y)) return;
  const Links t = face_transmittances(x, y, z CLPV_PASS_TRANSMITTANCE);
  store_step(gain_light(source, channel, x, y, z, t), target, sum_so_far, sum, channel, x, y, z);
}
