// SPDX-License-Identifier: MIT
// A cascade's grid of cubic light cells, as host and kernels both see it.
//
// Cell (i, j, k) fills origin + s [i, i+1] x [j, j+1] x [k, k+1]; its sample is its centre.
// Geometry samples stand on the cells' corners: sample (i, j, k) at origin + s (i, j, k), i in 0..n.
#ifndef CLPV_SHARED_GRID_H
#define CLPV_SHARED_GRID_H

typedef struct {
  float origin[3];  // least corner [m], a whole multiple of cell
  float cell;       // edge s of a cell [m]
  unsigned int n;   // cells along each axis
  float middle[3];  // [m]: the eye that cascades stand round, in the cell of that number n / 2; what it lights fades about it
} ClpvGrid;

#define CLPV_SIZEOF_GRID 32

// Cells to either side of `middle` that lie in a grid of n along each axis, wherever in its cell `middle` is.
#define CLPV_GRID_REACH(n) (((n) - 1) / 2)

#endif
