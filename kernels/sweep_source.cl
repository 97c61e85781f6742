// SPDX-License-Identifier: MIT
// What a sweep starts from: injected light, as means over the 24 bins of directions.
//
// In: light volume [W/sr] of any basis and layout. Out: `sources`, a volume of rows for each channel and bin (sweep.h); of
// directions across x (bins 0 to 7) turned. The host writes the struct Swept and Swept clpv_bin_means(Coefficients).
// A work-item is a tile of CLPV_LANES x CLPV_LANES cells of a slice of one channel.
#include "coefficients.h"
#include "sweep.h"
#include "volume/light.h"

__kernel void sweep_source(CLPV_VOLUME_IN injected, CLPV_BUFFER_OUT sources) {
  const int x = CLPV_LANES * (int)get_global_id(0), y = CLPV_LANES * (int)get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  CLPV_BUFFER_OUT out = sources + channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;
  Tile tile[CLPV_TURNED_BINS];
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r < CLPV_GRID) {
      const Swept s = clpv_bin_means(light_load(injected, channel, x, y + r, z));
      const int at = clpv_row_of(x, y + r, z);
#define CLPV_DO(b) CLPV_SWEEP_STORE(out + b * CLPV_SWEEP_VOLUME, at, CLPV_WITHIN(x, s.c##b));
      CLPV_EACH_STRAIGHT_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) tile[b].row[r] = s.c##b;
      CLPV_EACH_TURNED_BIN(CLPV_DO)
    } else {
#undef CLPV_DO
#define CLPV_DO(b) tile[b].row[r] = 0.0f;
      CLPV_EACH_TURNED_BIN(CLPV_DO)
#undef CLPV_DO
    }
  }
  for (int b = 0; b < CLPV_TURNED_BINS; ++b) {
    const Tile turned = clpv_turn(tile[b]);
    for (int r = 0; r < CLPV_LANES; ++r) {
      if (x + r >= CLPV_GRID) break;
      CLPV_SWEEP_STORE(out + b * CLPV_SWEEP_VOLUME, clpv_row_of(y, x + r, z), turned.row[r]);
    }
  }
}
