// SPDX-License-Identifier: MIT
// Tiles of CLPV_LANES x CLPV_LANES cells, which convert between rows along x and volumes across any axis
// (sweep_layout.h). Volumes across y and z store rows along x; those across x store rows along y, so that tiles of them
// are transposed.
#ifndef CLPV_SWEEP_TILES_H
#define CLPV_SWEEP_TILES_H

#include "sweep/sweep_layout.h"

typedef struct {
  CLPV_REAL row[CLPV_LANES];
} SweepTile;

#if CLPV_LANES == 8
#define CLPV_COLUMN_OF_ROWS(s)                                                                                  \
  ((float8)(a.row[0].s, a.row[1].s, a.row[2].s, a.row[3].s, a.row[4].s, a.row[5].s, a.row[6].s, a.row[7].s))
CLPV_INLINE SweepTile clpv_transpose(const SweepTile a) {
  const SweepTile t = {{CLPV_COLUMN_OF_ROWS(s0), CLPV_COLUMN_OF_ROWS(s1), CLPV_COLUMN_OF_ROWS(s2),
                        CLPV_COLUMN_OF_ROWS(s3), CLPV_COLUMN_OF_ROWS(s4), CLPV_COLUMN_OF_ROWS(s5),
                        CLPV_COLUMN_OF_ROWS(s6), CLPV_COLUMN_OF_ROWS(s7)}};
  return t;
}
// Lanes beyond the grid's last cell become 0.
#define CLPV_WITHIN(x, value) \
  (CLPV_GRID % 8 == 0 ? (value) : select((float8)(0.0f), value, (x) + (int8)(0, 1, 2, 3, 4, 5, 6, 7) < CLPV_GRID))
#else
CLPV_INLINE SweepTile clpv_transpose(const SweepTile a) { return a; }
#define CLPV_WITHIN(x, value) (value)
#endif

#ifdef CLPV_X_BINS
// Loads the tile from cell (x, y, z) on of every bin across x, transposed: rows lie along x. `volumes`: one for each
// bin.
CLPV_INLINE void clpv_load_x_bins(CLPV_BUFFER_IN volumes, const int x, const int y, const int z, SweepTile* tiles) {
  for (int b = 0; b < CLPV_X_BINS; ++b) {
    SweepTile columns;
    for (int r = 0; r < CLPV_LANES; ++r) {
      columns.row[r] = 0.0f;
      if (x + r < CLPV_GRID)
        columns.row[r] = CLPV_SWEEP_LOAD(volumes + b * CLPV_SWEEP_VOLUME, clpv_sweep_at(x + r, z, y));
    }
    tiles[b] = clpv_transpose(columns);
  }
}

// All bins of the cells from (x, y, z) on, which are row r of `tiles`.
CLPV_INLINE Bins clpv_load_bins(CLPV_BUFFER_IN volumes, const SweepTile* tiles, const int r, const int x, const int y,
                                const int z) {
  const int across_z = clpv_sweep_at(z, y, x), across_y = clpv_sweep_at(y, z, x);
  Bins bins;
#define CLPV_DO(b) bins.c##b = tiles[b].row[r];
  CLPV_EACH_X_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) bins.c##b = CLPV_SWEEP_LOAD(volumes + b * CLPV_SWEEP_VOLUME, across_y);
  CLPV_EACH_Y_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) bins.c##b = CLPV_SWEEP_LOAD(volumes + b * CLPV_SWEEP_VOLUME, across_z);
  CLPV_EACH_Z_BIN(CLPV_DO)
#undef CLPV_DO
  return bins;
}
#endif

// Stores the tile from cell (x, y, z) on, whose rows lie along x, into a volume across x: transposed.
CLPV_INLINE void clpv_store_x_tile(CLPV_BUFFER_OUT volume, const SweepTile tile, const int x, const int y,
                                   const int z) {
  const SweepTile columns = clpv_transpose(tile);
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (x + r >= CLPV_GRID) break;
    CLPV_SWEEP_STORE(volume, clpv_sweep_at(x + r, z, y), columns.row[r]);
  }
}

#endif
