// SPDX-License-Identifier: MIT
// Keys of the cells that injection sorts texels by (sort_by_cell.cl): made by find_cells.cl, read by inject.cl.
//
// CLPV_TRILINEAR 0: cell (x, y, z) of `n` along each axis has the key (z n + y) n + x. Geometry volumes have n + 1
// corners instead of n cells.
// CLPV_TRILINEAR 1: a texel spreads over the 8 cells whose centres surround it, and the key is that of the corner they
// share. Two corners share cells unless their coordinates have the same parities: the eight combinations are the
// phases, one of which may be written at a time, most significant in the key, so that a phase is one stretch of the
// sorted texels.
#ifndef CLPV_CELL_KEYS_H
#define CLPV_CELL_KEYS_H

#include "shared/sort.h"

// Corners lie half a cell off the cells' centres: with this added to a point in units of cells, its whole part is the
// number of what it belongs to.
#if CLPV_TRILINEAR || CLPV_GEOMETRY
#define CLPV_KEYS(cells) ((cells) + 1)
#define CLPV_CELL_SHIFT 0.5f
#else
#define CLPV_KEYS(cells) (cells)
#define CLPV_CELL_SHIFT 0.0f
#endif

// `n`: CLPV_KEYS of the grid.
static inline uint cell_key(const uint n, const uint x, const uint y, const uint z) {
#if CLPV_TRILINEAR
  const uint pairs = (n + 1) / 2, parity = x % 2 + 2 * (y % 2) + 4 * (z % 2);
  return ((parity * pairs + z / 2) * pairs + y / 2) * pairs + x / 2;
#else
  return (z * n + y) * n + x;
#endif
}

static inline uint phase_of(const uint n, const uint key) {
#if CLPV_TRILINEAR
  const uint pairs = (n + 1) / 2;
  return key / (pairs * pairs * pairs);
#else
  return 0;
#endif
}

// The cell or corner of a key.
static inline int3 cell_of(const uint n, const uint key) {
#if CLPV_TRILINEAR
  const uint pairs = (n + 1) / 2, phase = phase_of(n, key);
  return (int3)(2 * (key % pairs) + phase % 2, 2 * (key / pairs % pairs) + phase / 2 % 2,
                2 * (key / (pairs * pairs) % pairs) + phase / 4);
#else
  return (int3)(key % n, key / n % n, key / (n * n));
#endif
}

#endif
