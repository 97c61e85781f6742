// SPDX-License-Identifier: MIT
// Injection, last step: how the sum of a cell's texels gets into the volume.
//
//   void deliver(volume, key, sums)   adds (light) or merges (geometry)
#ifndef CLPV_DELIVER_H
#define CLPV_DELIVER_H

#include "cell_keys.h"

#if CLPV_GEOMETRY
#include "volume/geometry.h"
#define CLPV_EACH_CHANNEL(DO) DO(0)
#define CLPV_CHANNELS 1
#else
#include "volume/light.h"
#define CLPV_EACH_CHANNEL(DO) DO(0) DO(1) DO(2)
#define CLPV_CHANNELS 3
#endif

// What the texels of a cell add up to: weighted integrals alpha, a channel each.
typedef struct {
#define CLPV_DO(channel) Sum k##channel;
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
} Sums;

// One cell's coefficients of a projected sum.
static inline Coefficients one_lane(const Sum* sum, const int lane) {
  Coefficients c;
#define CLPV_DO(i) c.c##i = ((const float*)&sum->c##i)[lane];
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return c;
}

#if CLPV_TRILINEAR

static inline void deliver(CLPV_VOLUME_OUT volume, const uint key, const Sums sums) {
  const int3 corner = cell_of(CLPV_KEYS(CLPV_GRID), key);
#define CLPV_DO(channel) const Sum projected##channel = clpv_project_sum(sums.k##channel);
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
  for (int lane = 0; lane < 8; ++lane) {
    const int cx = corner.x - 1 + lane % 2, cy = corner.y - 1 + lane / 2 % 2, cz = corner.z - 1 + lane / 4;
    if (min(min(cx, cy), cz) < 0 || max(max(cx, cy), cz) >= CLPV_GRID) continue;
#define CLPV_DO(channel)                                                         \
  light_store(volume, channel, cx, cy, cz,                                       \
              clpv_add_scaled(light_load(volume, channel, cx, cy, cz), M_1_PI_F, \
                              one_lane(&projected##channel, lane)));
    CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
  }
}

#else

static inline void deliver(CLPV_VOLUME_OUT volume, const uint key, const Sums sums) {
  const int3 cell = cell_of(CLPV_KEYS(CLPV_GRID), key);
#define CLPV_DO(channel) const Sum projected##channel = clpv_project_sum(sums.k##channel);
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
#if CLPV_GEOMETRY
  geometry_store(volume, 0, cell.x, cell.y, cell.z,
                 clpv_merge(one_lane(&projected0, 0), geometry_load(volume, 0, cell.x, cell.y, cell.z)));
#else
#define CLPV_DO(channel)                                                                     \
  light_store(volume, channel, cell.x, cell.y, cell.z,                                       \
              clpv_add_scaled(light_load(volume, channel, cell.x, cell.y, cell.z), M_1_PI_F, \
                              one_lane(&projected##channel, 0)));
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
#endif
}

#endif
#endif
