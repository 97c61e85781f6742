// SPDX-License-Identifier: MIT
// Grid of cubic light cells of a cascade, shared by host and kernels.
//
// Cell (i, j, k) is the cube origin + s [i, i+1] x [j, j+1] x [k, k+1]; light is sampled at its
// centre. Geometry is sampled at the corners: sample (i, j, k) at origin + s (i, j, k), i in 0..n.
#pragma once

typedef struct {
  float origin[3];  // lowest corner [m], a multiple of cell
  float cell;       // edge s of a cell [m]
  unsigned int n;   // cells along each axis
  float middle[3];  // [m] eye, in cell n / 2 along each axis; gathering blends cascades by the
                    // distance from it
} ClpvGrid;

// Cells on each side of `middle` that lie inside a grid of n cells along each axis, for any
// position of `middle` in its cell.
static inline int grid_reach(const int n) { return (n - 1) / 2; }
