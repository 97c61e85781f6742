// SPDX-License-Identifier: MIT
// Copies injected light into the layout of a sweep (sweep_layout.h) and marks the rows of cells
// that hold any: few do, and a sweep reads sources only in those rows (sweep_cell.h).
//
// In:   injected  light volume [W/sr], any basis and layout
// Out:  sources   coefficients [W/sr], CLPV_N volumes of each of 3 channels across z, then the same
//                 across x. A volume across z has its rows along x, and serves bins across y too.
//                 With W 8 dark tiles are not written.
//       lit       1 for each W cells of a row that hold light in any channel, else 0; of a volume
//                 across z, then of one across x
// A work-item copies a tile of W x W cells of a slice.
#include "volume/coefficients.h"
#include "lanes.h"
#include "shared/sweep.h"
#include "sweep/sweep_tiles.h"
#include "volume/light.h"

// Sum of the absolute values of all coefficients, for W cells of a row.
CLPV_INLINE realW sum_light(CLPV_VOLUME_IN injected, const int x, const int y, const int z) {
  realW sum = 0.0f;
  for (int channel = 0; channel < 3; ++channel) {
    const Coefficients c = light_load(injected, channel, x, y, z);
#pragma unroll
    for (int i = 0; i < CLPV_N; ++i) sum += fabs(c.c[i]);
  }
  return zero_outside(x, sum);
}

// Copies a channel of a tile, across z and across x.
CLPV_INLINE void copy_tile(CLPV_VOLUME_IN injected, CLPV_BUFFER_OUT sources, const int channel,
                           const int x, const int y, const int z) {
  CLPV_BUFFER_OUT across_z = sources + channel * CLPV_N * CLPV_SWEEP_VOLUME;
  CLPV_BUFFER_OUT across_x = across_z + 3 * CLPV_N * CLPV_SWEEP_VOLUME;
  SweepTile tiles[CLPV_N];
  for (int r = 0; r < W; ++r) {
    Coefficients c = zero_coefficients();
    if (y + r < CLPV_GRID) {
      c = light_load(injected, channel, x, y + r, z);
#pragma unroll
      for (int i = 0; i < CLPV_N; ++i)
        write_numbers(across_z + i * CLPV_SWEEP_VOLUME, sweep_index(z, y + r, x),
                      zero_outside(x, c.c[i]));
    }
#pragma unroll
    for (int i = 0; i < CLPV_N; ++i) tiles[i].row[r] = c.c[i];
  }
  for (int i = 0; i < CLPV_N; ++i)
    store_x_tile(across_x + i * CLPV_SWEEP_VOLUME, tiles[i], x, y, z);
}

__kernel void sweep_source(CLPV_VOLUME_IN injected, CLPV_BUFFER_OUT sources, __global uchar* lit) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1), z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  realW columns = 0.0f;
  for (int r = 0; r < W; ++r) {
    if (y + r >= CLPV_GRID) break;
    const realW row = sum_light(injected, x, y + r, z);
    lit[sweep_index(z, y + r, x) / W] = !no_lane(row != 0.0f);
    columns += row;
  }
  float light[W];
  store_lanes(columns, light);
  for (int r = 0; r < W; ++r) {
    if (x + r >= CLPV_GRID) break;
    lit[(CLPV_SWEEP_VOLUME + sweep_index(x + r, z, y)) / W] = light[r] != 0.0f;
  }
  // With W 8, a tile without light need not be written. With W 1 it must: a sweep of eight lanes
  // also reads the dark neighbours of a cell with light.
  if (W == 8 && no_lane(columns != 0.0f)) return;
  for (int channel = 0; channel < 3; ++channel) copy_tile(injected, sources, channel, x, y, z);
}
