// SPDX-License-Identifier: MIT
// Writes the light that a sweep injects in its layout (sweep_layout.h), and marks the rows of cells
// that hold any: few do, and a sweep reads sources only in those rows (sweep_cell.h).
//
//   sources   coefficients [W/sr], CLPV_N volumes of each of 3 channels across z, then the same
//             across x. A volume across z has its rows along x, and serves bins across y too. With
//             W 8 dark tiles are not written.
//   lit       1 for each W cells of a row that hold light in any channel, else 0; of a volume
//             across z, then of one across x
#pragma once

#include "sweep/sweep_tiles.h"
#include "volume/coefficients.h"

// Light [W/sr] of a tile of W x W cells of a slice: its rows in each channel, 0 outside the grid.
typedef struct {
  Coefficients row[3][W];
} TileLight;

CLPV_INLINE TileLight dark_light(void) {
  TileLight light;
  const Coefficients dark = zero_coefficients();
  for (int channel = 0; channel < 3; ++channel)
    for (int r = 0; r < W; ++r) copy_coefficients(&dark, &light.row[channel][r]);
  return light;
}

// Sets row r of a channel to light as a volume stores it.
CLPV_INLINE void set_light(TileLight* light, const int channel, const int r,
                           const Coefficients c) {
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) light->row[channel][r].c[i] = stored_numbers(c.c[i]);
}

// Sum of the absolute values of all coefficients, for W cells of a row.
CLPV_INLINE realW sum_light(const TileLight* light, const int r, const int x) {
  realW sum = 0.0f;
  for (int channel = 0; channel < 3; ++channel) {
#pragma unroll
    for (int i = 0; i < CLPV_N; ++i) sum += fabs(light->row[channel][r].c[i]);
  }
  return zero_outside(x, sum);
}

// Writes a channel of the tile from cell (x, y, z) on, across z and across x.
CLPV_INLINE void write_channel(const TileLight* light, const int channel, const int x, const int y,
                               const int z, CLPV_BUFFER_OUT sources) {
  CLPV_BUFFER_OUT across_z = sources + channel * CLPV_N * CLPV_SWEEP_VOLUME;
  CLPV_BUFFER_OUT across_x = across_z + 3 * CLPV_N * CLPV_SWEEP_VOLUME;
  for (int i = 0; i < CLPV_N; ++i) {
    SweepTile tile;
    for (int r = 0; r < W; ++r) {
      tile.row[r] = light->row[channel][r].c[i];
      if (y + r < CLPV_GRID)
        write_numbers(across_z + i * CLPV_SWEEP_VOLUME, sweep_index(z, y + r, x),
                      zero_outside(x, tile.row[r]));
    }
    store_x_tile(across_x + i * CLPV_SWEEP_VOLUME, tile, x, y, z);
  }
}

// Writes the sources of the work-item's tile, unless it lies outside the grid.
CLPV_INLINE void write_sources(const TileLight* light, CLPV_BUFFER_OUT sources,
                               __global uchar* lit) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1), z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  realW columns = 0.0f;
  for (int r = 0; r < W; ++r) {
    if (y + r >= CLPV_GRID) break;
    const realW row = sum_light(light, r, x);
    lit[sweep_index(z, y + r, x) / W] = !no_lane(row != 0.0f);
    columns += row;
  }
  float sums[W];
  store_lanes(columns, sums);
  for (int r = 0; r < W; ++r) {
    if (x + r >= CLPV_GRID) break;
    lit[(CLPV_SWEEP_VOLUME + sweep_index(x + r, z, y)) / W] = sums[r] != 0.0f;
  }
  // With W 8, a tile without light need not be written. With W 1 it must: a sweep of eight lanes
  // also reads the dark neighbours of a cell with light.
  if (W == 8 && no_lane(columns != 0.0f)) return;
  for (int channel = 0; channel < 3; ++channel) write_channel(light, channel, x, y, z, sources);
}
