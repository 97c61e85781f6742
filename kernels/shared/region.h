// SPDX-License-Identifier: MIT
// Region of a cascade that is voxelised again, as a union of boxes, shared by host and kernels
// (docs/method.md, 'Incremental voxelisation').
//
// Positions count from `base`, a point near the cascade that stays fixed while the cascade moves. A
// triangle then has the same coordinates, to the bit, wherever the cascade is, and masks of cells
// outside the region stay valid.
#pragma once

#define CLPV_REGION_BOXES 8

typedef struct {
  int low[3], high[3];  // first and last cell of the cascade, both included
} ClpvBox;

typedef struct {
  float base[3];       // [m]
  float cell;          // edge of a cell [m]
  int first[3];        // cells from the base to the cascade's first cell
  unsigned int boxes;  // number of boxes; they may overlap
  int moved[3];        // cells that the cascade moved by since the last update
  unsigned int unused;
  ClpvBox all;  // bounds of all boxes
  ClpvBox box[CLPV_REGION_BOXES];
} ClpvRegion;

// Triangles of a cluster: neighbours in the scene that are processed or skipped together.
enum { CLPV_CLUSTER = 64 };
