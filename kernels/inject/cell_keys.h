// SPDX-License-Identifier: MIT
// Keys of cells, by which injection sorts texels (find_cells.cl, sort_by_cell.cl, light.cl,
// surfels.cl).
//
// Cell (x, y, z) of n^3 has the key ((s n + z) n + y) n + x for surface s. Geometry volumes have
// n + 1 corners along each axis instead of n cells.
#pragma once

#include "shared/sort.h"

// `n`: cells, or corners, along each axis.
static inline uint cell_key(const uint n, const uint x, const uint y, const uint z) {
  return (z * n + y) * n + x;
}

// Cell or corner of a key of surface 0.
static inline int3 cell_of(const uint n, const uint key) {
  return (int3)(key % n, key / n % n, key / (n * n));
}
