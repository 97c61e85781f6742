// SPDX-License-Identifier: MIT
// Tiles of W x W cells, which convert between rows along x and volumes across any axis
// (sweep_layout.h). Volumes across y and z store rows along x; those across x store rows along y,
// so that tiles of them are transposed.
#pragma once

#include "sweep/sweep_layout.h"

typedef struct {
  realW row[W];
} SweepTile;

CLPV_INLINE SweepTile transpose_tile(const SweepTile a) {
  SweepTile t;
#pragma unroll
  for (int r = 0; r < W; ++r) {
#pragma unroll
    for (int i = 0; i < W; ++i) ((float*)(t.row + r))[i] = ((const float*)(a.row + i))[r];
  }
  return t;
}

// Sets lanes beyond the grid's last cell to 0.
CLPV_INLINE realW zero_outside(const int x, const realW value) {
  if (CLPV_GRID % W == 0) return value;
  return x + lane_numbers() < CLPV_GRID ? value : ZERO;
}

// Numbers of W cells in each bin. The first CLPV_AXIS_BINS bins are swept across x, then follow
// those across y and z.
typedef struct {
  realW c[CLPV_SWEEP_BINS];
} Bins;

// Loads the tile from cell (x, y, z) on of every bin across x, transposed: rows lie along x.
// `volumes`: one for each bin.
CLPV_INLINE void load_x_bins(CLPV_BUFFER_IN volumes, const int x, const int y, const int z,
                             SweepTile* tiles) {
  for (int b = 0; b < CLPV_AXIS_BINS; ++b) {
    SweepTile columns;
    for (int r = 0; r < W; ++r) {
      columns.row[r] = 0.0f;
      if (x + r < CLPV_GRID)
        columns.row[r] = read_numbers(volumes + b * CLPV_SWEEP_VOLUME, sweep_index(x + r, z, y));
    }
    const SweepTile transposed = transpose_tile(columns);  // as in copy_coefficients()
    for (int r = 0; r < W; ++r) tiles[b].row[r] = transposed.row[r];
  }
}

// Index of cell (x, y, z) in a volume of bin b across y or z.
CLPV_INLINE int bin_index(const int b, const int x, const int y, const int z) {
  return b < 2 * CLPV_AXIS_BINS ? sweep_index(y, z, x) : sweep_index(z, y, x);
}

// All bins of the cells from (x, y, z) on, which are row r of `tiles`.
CLPV_INLINE Bins load_bins(CLPV_BUFFER_IN volumes, const SweepTile* tiles, const int r, const int x,
                           const int y, const int z) {
  Bins bins;
#pragma unroll
  for (int b = 0; b < CLPV_AXIS_BINS; ++b) bins.c[b] = tiles[b].row[r];
#pragma unroll
  for (int b = CLPV_AXIS_BINS; b < CLPV_SWEEP_BINS; ++b)
    bins.c[b] = read_numbers(volumes + b * CLPV_SWEEP_VOLUME, bin_index(b, x, y, z));
  return bins;
}

// Stores the tile from cell (x, y, z) on, whose rows lie along x, into a volume across x:
// transposed.
CLPV_INLINE void store_x_tile(CLPV_BUFFER_OUT volume, const SweepTile tile, const int x,
                              const int y, const int z) {
  const SweepTile columns = transpose_tile(tile);
  for (int r = 0; r < W; ++r) {
    if (x + r >= CLPV_GRID) break;
    write_numbers(volume, sweep_index(x + r, z, y), columns.row[r]);
  }
}
