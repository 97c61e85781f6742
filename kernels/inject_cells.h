// Injection's cells: which one a point falls into, as a key to sort by, and how a cell's sum gets into the volume.
//
//   CLPV_CELL_SHIFT                 added to a point in units of cells, its whole part is the number of its cell
//   int in_grid(x, y, z)           whether a point so shifted has a cell
//   uint cell_key(x, y, z)          key of a cell
//   uint phase_of(key)              keys of one phase may be delivered at the same time
//   void deliver(volume, key, sums) adds (light) or merges (geometry) the sum of a cell's texels
//
// Trilinear: a texel spreads over the 8 cells whose centres surround it. Its key is that of those 8 together, the
// corner they share, and sums have 8 lanes, one a cell. Two corners share cells unless their coordinates have the
// same parities: the eight combinations are the phases, most significant in the key, so that a phase is one stretch of
// the sorted texels.
#ifndef CLPV_INJECT_CELLS_H
#define CLPV_INJECT_CELLS_H

#include "shared/sort.h"

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

// Keys stand for cells, or for corners, which lie half a cell off the cells' centres.
#if CLPV_TRILINEAR || CLPV_GEOMETRY
#define CLPV_KEYS (CLPV_GRID + 1)
#define CLPV_CELL_SHIFT 0.5f
#else
#define CLPV_KEYS CLPV_GRID
#define CLPV_CELL_SHIFT 0.0f
#endif
#define CLPV_HALF_KEYS ((CLPV_KEYS + 1) / 2)

static inline int in_grid(const float x, const float y, const float z) {
  const float top = (float)CLPV_KEYS;
  return (x >= 0.0f) & (y >= 0.0f) & (z >= 0.0f) & (x < top) & (y < top) & (z < top);
}

static inline uint cell_key(const uint x, const uint y, const uint z) {
#if CLPV_TRILINEAR
  const uint parity = x % 2 + 2 * (y % 2) + 4 * (z % 2);
  return ((parity * CLPV_HALF_KEYS + z / 2) * CLPV_HALF_KEYS + y / 2) * CLPV_HALF_KEYS + x / 2;
#else
  return (z * CLPV_KEYS + y) * CLPV_KEYS + x;
#endif
}

// One cell's coefficients of a projected sum.
static inline Coefficients one_lane(const Sum* sum, const int lane) {
  Coefficients c;
#define CLPV_DO(i) c.c##i = ((const float*)&sum->c##i)[lane];
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return c;
}

#if CLPV_TRILINEAR

static inline uint phase_of(const uint key) {
  return key / (CLPV_HALF_KEYS * CLPV_HALF_KEYS * CLPV_HALF_KEYS);
}

static inline void deliver(CLPV_VOLUME_OUT volume, const uint key, const Sums sums) {
  const int phase = phase_of(key);
  const int x = 2 * (key % CLPV_HALF_KEYS) + phase % 2;
  const int y = 2 * (key / CLPV_HALF_KEYS % CLPV_HALF_KEYS) + phase / 2 % 2;
  const int z = 2 * (key / (CLPV_HALF_KEYS * CLPV_HALF_KEYS) % CLPV_HALF_KEYS) + phase / 4;
#define CLPV_DO(channel) const Sum projected##channel = clpv_project_sum(sums.k##channel);
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
  for (int lane = 0; lane < 8; ++lane) {
    const int cx = x - 1 + lane % 2, cy = y - 1 + lane / 2 % 2, cz = z - 1 + lane / 4;
    if (min(min(cx, cy), cz) < 0 || max(max(cx, cy), cz) >= CLPV_GRID) continue;
#define CLPV_DO(channel)                                                           \
  light_store(volume, channel, cx, cy, cz,                                         \
              clpv_add_scaled(light_load(volume, channel, cx, cy, cz), M_1_PI_F,   \
                              one_lane(&projected##channel, lane)));
    CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
  }
}

#else

static inline uint phase_of(const uint key) { return 0; }

#if CLPV_GEOMETRY
static inline Coefficients larger_mean(const Coefficients found, const Coefficients kept) {
  return clpv_mean(found) > clpv_mean(kept) ? found : kept;
}
#endif

static inline void deliver(CLPV_VOLUME_OUT volume, const uint key, const Sums sums) {
  const int x = key % CLPV_KEYS, y = key / CLPV_KEYS % CLPV_KEYS, z = key / (CLPV_KEYS * CLPV_KEYS);
#define CLPV_DO(channel) const Sum projected##channel = clpv_project_sum(sums.k##channel);
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
#if CLPV_GEOMETRY
  geometry_store(volume, 0, x, y, z,
                 larger_mean(one_lane(&projected0, 0), geometry_load(volume, 0, x, y, z)));
#else
#define CLPV_DO(channel)                                                         \
  light_store(volume, channel, x, y, z,                                          \
              clpv_add_scaled(light_load(volume, channel, x, y, z), M_1_PI_F,    \
                              one_lane(&projected##channel, 0)));
  CLPV_EACH_CHANNEL(CLPV_DO)
#undef CLPV_DO
#endif
}

#endif
#endif
