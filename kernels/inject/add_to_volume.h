// SPDX-License-Identifier: MIT
// Adds the sum of a cell's texels to a volume: the last step of injection (inject.cl).
//
//   deliver(volume, key, sums)   adds (1 / pi) A^-1 sums to a light volume, or merges A^-1 sums
//                                into a geometry volume
#pragma once

#include "inject/cell_keys.h"

#if CLPV_GEOMETRY
#include "volume/geometry.h"
#define CLPV_CHANNELS 1
#else
#include "volume/light.h"
#define CLPV_CHANNELS 3
#endif

// Sums of weighted integrals alpha over the texels of a cell, for each channel.
typedef struct {
  Coefficients channel[CLPV_CHANNELS];
} Sums;

static inline void deliver(CLPV_VOLUME_OUT volume, const uint key, const Sums sums) {
  const int3 cell = cell_of(CLPV_KEYS(CLPV_GRID), key);
#if CLPV_GEOMETRY
  geometry_store(volume, 0, cell.x, cell.y, cell.z,
                 merge_blockers(project_blockers(sums.channel[0]),
                                geometry_load(volume, 0, cell.x, cell.y, cell.z)));
#else
#pragma unroll
  for (int c = 0; c < CLPV_CHANNELS; ++c)
    light_store(volume, c, cell.x, cell.y, cell.z,
                add_scaled(light_load(volume, c, cell.x, cell.y, cell.z), M_1_PI_F,
                           project_sum(sums.channel[c])));
#endif
}
