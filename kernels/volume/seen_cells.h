// SPDX-License-Identifier: MIT
// Cells that sample points of visibility see (voxels/visibility.cl), a bit each of a cube of eight.
#pragma once

// Cells that the sample point (a, b, c) [quarters of cells] sees, in a grid of n^3 cells.
static inline uint seen_cells(__global const uchar* occluded, const int n, const int a, const int b,
                              const int c) {
  const int cube = ((c >> 2) * n + (b >> 2)) * n + (a >> 2),
            point = ((c & 3) * 4 + (b & 3)) * 4 + (a & 3);
  return ~(uint)occluded[64 * (size_t)cube + point] & 255u;
}

// Cells of a cube as cells of the cube that the steps (x, y, z), each -1, 0 or 1, lead away from.
static inline uint cells_from(uint cells, const int x, const int y, const int z) {
  cells = x > 0 ? (cells & 0x55u) << 1 : x < 0 ? (cells & 0xaau) >> 1 : cells;
  cells = y > 0 ? (cells & 0x33u) << 2 : y < 0 ? (cells & 0xccu) >> 2 : cells;
  return z > 0 ? (cells & 0x0fu) << 4 : z < 0 ? (cells & 0xf0u) >> 4 : cells;
}
