// SPDX-License-Identifier: MIT
// What each light cell reflects, from what reflectors.cl counted: of each side the share of samples covered, times the mean of
// what a sample reflects. What covers the same counts once, so that no side reflects more than falls on a face.
//
// A sweep takes light through an edge between two sides of a cell once, and what arrives is counted on both. Each side
// therefore reflects less by CLPV_EDGE_LOSS of the shares of those across it (host/basis/bounce.hpp).
//
// Out: six numbers a cell and channel in [0, 1], by the order of sides in shared/reflectors.h. A work-item is a cell.
#include "coefficients.h"
#include "shared/reflectors.h"
#include "volume/light.h"

static inline float clpv_share(__global const uint* side) {
  return (float)(popcount(side[0]) + popcount(side[1])) * (1.0f / 64.0f);
}

__kernel void face_albedo(__global const uint* sides, CLPV_VOLUME_OUT reflectors) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  __global const uint* cell =
      sides + (size_t)((z * CLPV_GRID + y) * CLPV_GRID + x) * (CLPV_SIDES * CLPV_SIDE_WORDS);
  float kept[3];  // by the two sides across each axis, of what falls on others
  for (int axis = 0; axis < 3; ++axis) {
    __global const uint* up = cell + 2 * axis * CLPV_SIDE_WORDS;
    kept[axis] = (1.0f - CLPV_EDGE_LOSS * clpv_share(up)) * (1.0f - CLPV_EDGE_LOSS * clpv_share(up + CLPV_SIDE_WORDS));
  }
  Coefficients red, green, blue;
#define CLPV_DO(i)                                                                                        \
  {                                                                                                       \
    __global const uint* side = cell + (i)*CLPV_SIDE_WORDS;                                               \
    const float share = clpv_share(side) * kept[((i) / 2 + 1) % 3] * kept[((i) / 2 + 2) % 3];             \
    const float each = 1.0f / (CLPV_REFLECT_UNIT * (float)max(side[CLPV_SIDE_COUNT], 1u));                \
    red.c##i = share * fmin(each * (float)side[CLPV_SIDE_COLOUR], 1.0f);                                  \
    green.c##i = share * fmin(each * (float)side[CLPV_SIDE_COLOUR + 1], 1.0f);                            \
    blue.c##i = share * fmin(each * (float)side[CLPV_SIDE_COLOUR + 2], 1.0f);                             \
  }
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  light_store(reflectors, 0, x, y, z, red);
  light_store(reflectors, 1, x, y, z, green);
  light_store(reflectors, 2, x, y, z, blue);
}
