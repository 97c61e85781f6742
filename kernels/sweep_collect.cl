// SPDX-License-Identifier: MIT
// What is kept of a sweep: a light volume of nine spherical harmonics, radiance times s^2 (docs/method.md, 'The sweep').
//
// In: `sums`, a volume for each channel and bin (sweep.h). Out: `accumulated`, of any layout. CLPV_EACH_X_BIN and the like:
// sweep_source.cl. The host writes the struct Swept and Coefficients clpv_projected(Swept).
// CLPV_FOR_FINER 1: out as well `arriving`, a volume for each channel and side, its planes across z: the flux on each whole face, for the
// bounces of the next finer cascade (bounce.cl). The host then writes Sides clpv_arriving(Swept) besides.
// A work-item is a tile of CLPV_LANES x CLPV_LANES cells of a slice of one channel.
#ifndef CLPV_FOR_FINER
#define CLPV_FOR_FINER 0
#endif
#include "coefficients.h"
#include "shared/reflectors.h"
#include "shared/sweep.h"
#include "sweep.h"
#include "volume/light.h"

#if CLPV_FOR_FINER
#define CLPV_AND_ARRIVING , CLPV_BUFFER_OUT arriving
#else
#define CLPV_AND_ARRIVING
#endif

__kernel void sweep_collect(CLPV_BUFFER_IN sums, CLPV_VOLUME_OUT accumulated CLPV_AND_ARRIVING) {
  const int x = CLPV_LANES * (int)get_global_id(0), y = CLPV_LANES * (int)get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  CLPV_BUFFER_IN in = sums + channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;
  Tile tile[CLPV_X_BINS];
  clpv_load_tiles(in, CLPV_X_BINS, x, y, z, tile);
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r >= CLPV_GRID) break;
    const int across_z = clpv_sweep_at(z, y + r, x), across_y = clpv_sweep_at(y + r, z, x);
    Swept m;
#define CLPV_DO(b) m.c##b = tile[b].row[r];
    CLPV_EACH_X_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) m.c##b = CLPV_SWEEP_LOAD(in + b * CLPV_SWEEP_VOLUME, across_y);
    CLPV_EACH_Y_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) m.c##b = CLPV_SWEEP_LOAD(in + b * CLPV_SWEEP_VOLUME, across_z);
    CLPV_EACH_Z_BIN(CLPV_DO)
#undef CLPV_DO
    light_store(accumulated, channel, x, y + r, z, clpv_projected(m));
#if CLPV_FOR_FINER
    const Sides on = clpv_arriving(m);
    const int bordered = clpv_bordered_at(z, y + r, x);
    CLPV_BUFFER_OUT sides = arriving + channel * CLPV_SIDES * CLPV_BORDERED_VOLUME;
#define CLPV_DO(i) CLPV_SWEEP_STORE(sides + i * CLPV_BORDERED_VOLUME, bordered, CLPV_WITHIN(x, on.c##i));
    CLPV_EACH_SIDE(CLPV_DO)
#undef CLPV_DO
#endif
  }
}
