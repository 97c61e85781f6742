// SPDX-License-Identifier: MIT
// What a sweep leaves, as a light volume of the 24 bins of directions: radiance times s^2 (docs/method.md, 'The sweep').
//
// In: `sums`, a volume of rows for each channel and bin (sweep.h), turned ones first. Out: `accumulated`, of any layout.
// A work-item is a tile of CLPV_LANES x CLPV_LANES cells of a slice of one channel.
#include "coefficients.h"
#include "sweep.h"
#include "volume/light.h"

__kernel void sweep_collect(CLPV_BUFFER_IN sums, CLPV_VOLUME_OUT accumulated) {
  const int x = CLPV_LANES * (int)get_global_id(0), y = CLPV_LANES * (int)get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  CLPV_BUFFER_IN in = sums + channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;
  Tile tile[CLPV_TURNED_BINS];
  for (int b = 0; b < CLPV_TURNED_BINS; ++b) {
    Tile turned;
    for (int r = 0; r < CLPV_LANES; ++r) {
      turned.row[r] = 0.0f;
      if (x + r < CLPV_GRID)
        turned.row[r] = CLPV_SWEEP_LOAD(in + b * CLPV_SWEEP_VOLUME, clpv_row_of(y, x + r, z));
    }
    tile[b] = clpv_turn(turned);
  }
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r >= CLPV_GRID) break;
    const int at = clpv_row_of(x, y + r, z);
    Coefficients c;
#define CLPV_DO(b) c.c##b = tile[b].row[r];
    CLPV_EACH_TURNED_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) c.c##b = CLPV_SWEEP_LOAD(in + b * CLPV_SWEEP_VOLUME, at);
    CLPV_EACH_STRAIGHT_BIN(CLPV_DO)
#undef CLPV_DO
    light_store(accumulated, channel, x, y + r, z, c);
  }
}
