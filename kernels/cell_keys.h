// SPDX-License-Identifier: MIT
// Keys of the cells that injection sorts texels by (sort_by_cell.cl): made by find_cells.cl, read by inject.cl.
//
// Cell (x, y, z) of `n` along each axis has the key (z n + y) n + x. Geometry volumes have n + 1 corners instead of n
// cells.
#ifndef CLPV_CELL_KEYS_H
#define CLPV_CELL_KEYS_H

#include "shared/sort.h"

// Corners lie half a cell off the cells' centres: with this added to a point in units of cells, its whole part is the
// number of what it belongs to.
#if CLPV_GEOMETRY
#define CLPV_KEYS(cells) ((cells) + 1)
#define CLPV_CELL_SHIFT 0.5f
#else
#define CLPV_KEYS(cells) (cells)
#define CLPV_CELL_SHIFT 0.0f
#endif

// `n`: CLPV_KEYS of the grid.
static inline uint cell_key(const uint n, const uint x, const uint y, const uint z) {
  return (z * n + y) * n + x;
}

// The cell or corner of a key.
static inline int3 cell_of(const uint n, const uint key) {
  return (int3)(key % n, key / n % n, key / (n * n));
}

#endif
