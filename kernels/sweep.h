// SPDX-License-Identifier: MIT
// How a sweep's numbers lie in memory: volumes of planes, one for each bin or link.
//
// A volume is of an axis: the planes across it follow each other, so that a direction walks through memory from one end to
// the other. Rows of a plane lie along x, and above each other along y in planes across z, along z in those across y; in
// planes across x they lie along y, above each other along z. A cache line or two more a plane and a volume: else numbers of the same
// cell in several of them would share the few places of a cache that powers of two have.
#ifndef CLPV_SWEEP_H
#define CLPV_SWEEP_H

#include "shared/sweep.h"
#include "volume/numbers.h"

#ifndef CLPV_INLINE
#define CLPV_INLINE static inline __attribute__((always_inline))
#endif
#ifndef CLPV_LANES
#define CLPV_LANES 8
#endif
#ifndef CLPV_REAL
#if CLPV_LANES == 8
#define CLPV_REAL float8
#else
#define CLPV_REAL float
#endif
#endif

#define CLPV_SWEEP_ROW CLPV_SWEEP_ROW_OF(CLPV_GRID)
#define CLPV_SWEEP_PLANE CLPV_SWEEP_PLANE_OF(CLPV_GRID)
#define CLPV_SWEEP_VOLUME CLPV_SWEEP_VOLUME_OF(CLPV_GRID)

// A plane by itself, and one of a volume of which a finer cascade asks for cells beside the grid, have a border of one cell all
// round.
#define CLPV_SWEEP_PITCH CLPV_SWEEP_PITCH_OF(CLPV_GRID)
#define CLPV_SWEEP_LIVE CLPV_SWEEP_LIVE_OF(CLPV_GRID)
#define CLPV_BORDERED_VOLUME CLPV_SWEEP_BORDERED_OF(CLPV_GRID)

#if CLPV_LANES == 8
#define CLPV_SWEEP_LOAD(from, at) CLPV_READ_ROW(from, at)
#define CLPV_SWEEP_STORE(to, at, value) CLPV_WRITE_ROW(to, at, value)
#define CLPV_LIVE_LOAD(from, at) vload8(0, (from) + (at))
#define CLPV_LIVE_STORE(to, at, value) vstore8(value, 0, (to) + (at))
#else
#define CLPV_SWEEP_LOAD(from, at) CLPV_READ(from, at)
#define CLPV_SWEEP_STORE(to, at, value) CLPV_WRITE(to, at, value)
#define CLPV_LIVE_LOAD(from, at) (from)[at]
#define CLPV_LIVE_STORE(to, at, value) (to)[at] = value
#endif

// A cell's place in a volume, in a plane by itself, and in a volume with a border.
CLPV_INLINE int clpv_sweep_at(const int plane, const int row, const int column) {
  return plane * CLPV_SWEEP_PLANE + row * CLPV_SWEEP_ROW + column;
}
CLPV_INLINE int clpv_live_at(const int row, const int column) {
  return (row + 1) * CLPV_SWEEP_PITCH + CLPV_SWEEP_FIRST + column;
}
CLPV_INLINE int clpv_bordered_at(const int plane, const int row, const int column) {
  return (plane + 1) * CLPV_SWEEP_LIVE + clpv_live_at(row, column);
}

// A tile of CLPV_LANES x CLPV_LANES cells, its rows turned into columns.
typedef struct {
  CLPV_REAL row[CLPV_LANES];
} Tile;

#if CLPV_LANES == 8
#define CLPV_TURNED(s)                                                                                          \
  ((float8)(a.row[0].s, a.row[1].s, a.row[2].s, a.row[3].s, a.row[4].s, a.row[5].s, a.row[6].s, a.row[7].s))
CLPV_INLINE Tile clpv_turn(const Tile a) {
  const Tile t = {{CLPV_TURNED(s0), CLPV_TURNED(s1), CLPV_TURNED(s2), CLPV_TURNED(s3), CLPV_TURNED(s4),
                   CLPV_TURNED(s5), CLPV_TURNED(s6), CLPV_TURNED(s7)}};
  return t;
}
// Zero beyond the grid's last cell.
#define CLPV_WITHIN(x, value) \
  (CLPV_GRID % 8 == 0 ? (value) : select((float8)(0.0f), value, (x) + (int8)(0, 1, 2, 3, 4, 5, 6, 7) < CLPV_GRID))
#else
CLPV_INLINE Tile clpv_turn(const Tile a) { return a; }
#define CLPV_WITHIN(x, value) (value)
#endif

// The tile of cells from (x, y, z) on of each of `volumes` across x, as rows along x.
CLPV_INLINE void clpv_load_tiles(CLPV_BUFFER_IN first, const int volumes, const int x, const int y, const int z, Tile* tiles) {
  for (int b = 0; b < volumes; ++b) {
    Tile turned;
    for (int r = 0; r < CLPV_LANES; ++r) {
      turned.row[r] = 0.0f;
      if (x + r < CLPV_GRID) turned.row[r] = CLPV_SWEEP_LOAD(first + b * CLPV_SWEEP_VOLUME, clpv_sweep_at(x + r, z, y));
    }
    tiles[b] = clpv_turn(turned);
  }
}

#endif
