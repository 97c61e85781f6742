// SPDX-License-Identifier: MIT
// Keys of cells, by which injection sorts texels (find_cells.cl, sort_by_cell.cl, inject.cl).
//
// Cell (x, y, z) of n^3 has the key (z n + y) n + x. Geometry volumes have n + 1 corners along each
// axis instead of n cells.
#pragma once

#include "shared/sort.h"

// Shift [cells] that is added to a point before its coordinates are rounded down: corners lie half
// a cell off the centres.
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

// Cell or corner of a key.
static inline int3 cell_of(const uint n, const uint key) {
  return (int3)(key % n, key / n % n, key / (n * n));
}
