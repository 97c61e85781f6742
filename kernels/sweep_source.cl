// SPDX-License-Identifier: MIT
// What a sweep starts from: injected light, as means over the 24 bins of directions.
//
// In: light volume [W/sr] of any basis and layout. Out: `sources`, a volume for each channel and bin (sweep.h). The host
// writes the struct Swept, Swept clpv_bin_means(Coefficients), and CLPV_EACH_X_BIN(DO) and the like, which write DO(bin)
// for each bin that is swept across that axis, those across x first. CLPV_Z_IN_PLACE 1: those across z are swept from where they
// were injected.
// A work-item is a tile of CLPV_LANES x CLPV_LANES cells of a slice of one channel.
#include "coefficients.h"
#include "shared/sweep.h"
#include "sweep.h"
#include "volume/light.h"

__kernel void sweep_source(CLPV_VOLUME_IN injected, CLPV_BUFFER_OUT sources) {
  const int x = CLPV_LANES * (int)get_global_id(0), y = CLPV_LANES * (int)get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  CLPV_BUFFER_OUT out = sources + channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;
  Tile tile[CLPV_X_BINS];
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r < CLPV_GRID) {
      const Swept s = clpv_bin_means(light_load(injected, channel, x, y + r, z));
      const int across_y = clpv_sweep_at(y + r, z, x);
#if !CLPV_Z_IN_PLACE
      const int across_z = clpv_sweep_at(z, y + r, x);
#define CLPV_DO(b) CLPV_SWEEP_STORE(out + b * CLPV_SWEEP_VOLUME, across_z, CLPV_WITHIN(x, s.c##b));
      CLPV_EACH_Z_BIN(CLPV_DO)
#undef CLPV_DO
#endif
#define CLPV_DO(b) CLPV_SWEEP_STORE(out + b * CLPV_SWEEP_VOLUME, across_y, CLPV_WITHIN(x, s.c##b));
      CLPV_EACH_Y_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) tile[b].row[r] = s.c##b;
      CLPV_EACH_X_BIN(CLPV_DO)
    } else {
#undef CLPV_DO
#define CLPV_DO(b) tile[b].row[r] = 0.0f;
      CLPV_EACH_X_BIN(CLPV_DO)
#undef CLPV_DO
    }
  }
  for (int b = 0; b < CLPV_X_BINS; ++b) {
    const Tile turned = clpv_turn(tile[b]);
    for (int r = 0; r < CLPV_LANES; ++r) {
      if (x + r >= CLPV_GRID) break;
      CLPV_SWEEP_STORE(out + b * CLPV_SWEEP_VOLUME, clpv_sweep_at(x + r, z, y), turned.row[r]);
    }
  }
}
