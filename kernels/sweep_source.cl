// SPDX-License-Identifier: MIT
// Converts injected light into the sources of a sweep: the mean intensity of each bin of directions.
//
//   I_b = sum_i M_bi c_i,   M_bi the mean of basis function i over bin b      (docs/method.md, 'The sweep')
//
// In:   injected  light volume [W/sr], any basis and layout
// Out:  sources   I [W/sr] of 3 channels and 24 bins (sweep_layout.h)
// From the host (host/codegen/sweep_source.cpp): struct Bins, Bins clpv_bin_means(Coefficients), and
// CLPV_EACH_X_BIN(DO), _Y_, _Z_, which write DO(bin) for the bins across an axis, those across x first. CLPV_Z_IN_PLACE
// 1: bins across z are swept from `injected`. A work-item computes a tile of CLPV_LANES x CLPV_LANES cells of a slice
// and channel.
#include "coefficients.h"
#include "shared/sweep.h"
#include "sweep_tiles.h"
#include "volume/light.h"

__kernel void sweep_source(CLPV_VOLUME_IN injected, CLPV_BUFFER_OUT sources) {
  const int x = CLPV_LANES * (int)get_global_id(0), y = CLPV_LANES * (int)get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  CLPV_BUFFER_OUT out = sources + channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;
  SweepTile tiles[CLPV_X_BINS];
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r < CLPV_GRID) {
      const Bins means = clpv_bin_means(light_load(injected, channel, x, y + r, z));
      const int across_y = clpv_sweep_at(y + r, z, x);
#if !CLPV_Z_IN_PLACE
      const int across_z = clpv_sweep_at(z, y + r, x);
#define CLPV_DO(b) CLPV_SWEEP_STORE(out + b * CLPV_SWEEP_VOLUME, across_z, CLPV_WITHIN(x, means.c##b));
      CLPV_EACH_Z_BIN(CLPV_DO)
#undef CLPV_DO
#endif
#define CLPV_DO(b) CLPV_SWEEP_STORE(out + b * CLPV_SWEEP_VOLUME, across_y, CLPV_WITHIN(x, means.c##b));
      CLPV_EACH_Y_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) tiles[b].row[r] = means.c##b;
      CLPV_EACH_X_BIN(CLPV_DO)
    } else {
#undef CLPV_DO
#define CLPV_DO(b) tiles[b].row[r] = 0.0f;
      CLPV_EACH_X_BIN(CLPV_DO)
#undef CLPV_DO
    }
  }
  for (int b = 0; b < CLPV_X_BINS; ++b) clpv_store_x_tile(out + b * CLPV_SWEEP_VOLUME, tiles[b], x, y, z);
}
