// SPDX-License-Identifier: MIT
// Data that a step loads and stores: neighbours of a cell, transmittances of links, light gained;
// shared by propagate.cl and propagate_lobes.cl.
//
// Face 5 k + f is the cell's face f of the five that are seen by the neighbour whose light travels
// along axis k, axes in the order +x, -x, +y, -y, +z, -z.
//
// With CLPV_BLOCKING 1 kernels have two more arguments (CLPV_AND_TRANSMITTANCE): the transmittance
// of each link into a cell (transmittance.cl), and `least`, a minimum for it: 1 in the first step,
// so that nothing blocks, else 0. From the host: CLPV_LINKS, the number of faces.
#pragma once

#include "volume/coefficients.h"
#include "volume/light.h"
#include "volume/links.h"

enum {
  CLPV_AXES = 6,
  CLPV_SEEN_FACES = 5,  // by a neighbour
  CLPV_FACES = CLPV_AXES * CLPV_SEEN_FACES,
};

// Loads the cell that light reaches cell (x, y, z) from along axis k.
CLPV_INLINE Coefficients load_upstream(CLPV_VOLUME_IN source, const int channel, const int k,
                                       const int x, const int y, const int z) {
  const int back = k % 2 == 0 ? -1 : 1;
  return light_load(source, channel, x + (k / 2 == 0 ? back : 0), y + (k / 2 == 1 ? back : 0),
                    z + (k / 2 == 2 ? back : 0));
}

// Transmittance of the link into a cell through each face.
#if CLPV_BLOCKING
#include "volume/transmittance.h"
#define CLPV_AND_TRANSMITTANCE , CLPV_VOLUME_IN transmittance, const float least
#define CLPV_PASS_TRANSMITTANCE , transmittance, least

CLPV_INLINE Links face_transmittances(const int x, const int y,
                                      const int z CLPV_AND_TRANSMITTANCE) {
  Links t = transmittance_load(transmittance, 0, x, y, z);
#pragma unroll
  for (int face = 0; face < CLPV_FACES; ++face) t.c[face] = max(t.c[face], (realW)(least));
  return t;
}
#else
#define CLPV_AND_TRANSMITTANCE
#define CLPV_PASS_TRANSMITTANCE

CLPV_INLINE Links face_transmittances(const int x, const int y, const int z) {
  Links t;
#pragma unroll
  for (int face = 0; face < CLPV_FACES; ++face) t.c[face] = 1.0f;
  return t;
}
#endif

// Stores the light that a cell gains in a step, and adds it to the sum of all steps.
CLPV_INLINE void store_step(const Coefficients gained, CLPV_VOLUME_OUT target,
                            CLPV_VOLUME_IN sum_so_far, CLPV_VOLUME_OUT sum, const int channel,
                            const int x, const int y, const int z) {
  light_store(target, channel, x, y, z, gained);
  light_store(sum, channel, x, y, z,
              add_coefficients(light_load(sum_so_far, channel, x, y, z), gained));
}
