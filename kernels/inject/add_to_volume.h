// SPDX-License-Identifier: MIT
// Adds the sum of a cell's texels to a volume: the last step of injection (inject.cl).
//
//   deliver(volume, key, sums)   adds (1 / pi) A^-1 sums to a light volume, or merges A^-1 sums into a geometry volume
#ifndef CLPV_ADD_TO_VOLUME_H
#define CLPV_ADD_TO_VOLUME_H

#include "inject/cell_keys.h"

#if CLPV_GEOMETRY
#include "volume/geometry.h"
#define CLPV_EACH_CHANNEL(DO) DO(0)
#define CLPV_CHANNELS 1
#else
#include "volume/light.h"
#define CLPV_EACH_CHANNEL(DO) DO(0) DO(1) DO(2)
#define CLPV_CHANNELS 3
#endif

// Sums of weighted integrals alpha over the texels of a cell, for each channel.
typedef struct {
#define CLPV_DO(channel) Coefficients k##channel;
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
} Sums;

static inline void deliver(CLPV_VOLUME_OUT volume, const uint key, const Sums sums) {
  const int3 cell = cell_of(CLPV_KEYS(CLPV_GRID), key);
#define CLPV_DO(channel) const Coefficients projected##channel = project_sum(sums.k##channel);
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
#if CLPV_GEOMETRY
  geometry_store(volume, 0, cell.x, cell.y, cell.z,
                 merge_blockers(projected0, geometry_load(volume, 0, cell.x, cell.y, cell.z)));
#else
#define CLPV_DO(channel)                                                                     \
  light_store(volume, channel, cell.x, cell.y, cell.z,                                       \
              add_scaled(light_load(volume, channel, cell.x, cell.y, cell.z), M_1_PI_F, \
                              projected##channel));
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
#endif
}

#endif
