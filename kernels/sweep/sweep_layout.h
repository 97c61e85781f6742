// SPDX-License-Identifier: MIT
// Memory layout of a sweep: one volume of planes for each bin or link (sizes: shared/sweep.h), and
// planes with a border.
//
// A volume belongs to an axis and stores the planes across it one after another, so that a
// direction walks through memory from one end to the other. (plane, row, column) is (z, y, x)
// across z, (y, z, x) across y and (x, z, y) across x. Padding of CLPV_SWEEP_LINE numbers after
// each plane and volume keeps a cell's numbers of several volumes in different cache sets.
#pragma once

#include "lanes.h"
#include "shared/sweep.h"
#include "volume/numbers.h"

#define CLPV_SWEEP_ROW sweep_row_size(CLPV_GRID)
#define CLPV_SWEEP_PLANE sweep_plane_size(CLPV_GRID)
#define CLPV_SWEEP_VOLUME sweep_volume_size(CLPV_GRID)

// Plane buffers, and volumes that a finer cascade interpolates, have a border of one cell on every
// side.
#define CLPV_SWEEP_PITCH bordered_pitch(CLPV_GRID)
#define CLPV_BORDERED_PLANE bordered_plane_size(CLPV_GRID)
#define CLPV_BORDERED_VOLUME bordered_volume_size(CLPV_GRID)

// Index of a cell in a volume, in a plane buffer and in a bordered volume.
CLPV_INLINE int sweep_index(const int plane, const int row, const int column) {
  return plane * CLPV_SWEEP_PLANE + row * CLPV_SWEEP_ROW + column;
}
CLPV_INLINE int plane_index(const int row, const int column) {
  return (row + 1) * CLPV_SWEEP_PITCH + CLPV_SWEEP_FIRST + column;
}
CLPV_INLINE int bordered_index(const int plane, const int row, const int column) {
  return (plane + 1) * CLPV_BORDERED_PLANE + plane_index(row, column);
}

// Pairs of the eight cell centres at the corners of a cube: seen_points.cl writes a byte for each
// pair and each centre, sweep_links.cl reads them.
enum {
  CLPV_CENTRES = 8,       // centre i is offset by (i & 1, i >> 1 & 1, i >> 2)
  CLPV_PAIRS = 28,        // numbers of centres follow
  CLPV_CUBE_POINTS = 64,
};

// Number of the pair of centres i < j: 0 to 27.
static inline int pair_number(const int i, const int j) { return i * (13 - i) / 2 + j - 1; }
// Number of a centre: 28 to 35.
static inline int centre_number(const int i) { return CLPV_PAIRS + i; }
