// SPDX-License-Identifier: MIT
// Cells of a cascade in which what triangles leave is made anew, as host and kernels both see them.
//
// Positions are taken from `base`, a place near the cascade that stays while the cascade moves about it: a triangle then has
// the same coordinates, to the bit, wherever the cascade stands, and what it leaves in a cell need not be made again.
#ifndef CLPV_SHARED_REGION_H
#define CLPV_SHARED_REGION_H

#define CLPV_REGION_BOXES 8

typedef struct {
  int low[3], high[3];  // cells of the cascade, both ends belong to it
} ClpvBox;

typedef struct {
  float base[3];       // [m]
  float cell;          // edge of a cell [m]
  int first[3];        // cells from base to the cascade's first one
  unsigned int boxes;  // that it is made of; a cell may be in several
  int moved[3];        // cells that the cascade moved by since it was last brought to date
  unsigned int unused;
  ClpvBox all;  // about all boxes
  ClpvBox box[CLPV_REGION_BOXES];
} ClpvRegion;

#define CLPV_SIZEOF_REGION 264

// Triangles next to each other in the scene that are kept or left out together.
#define CLPV_CLUSTER 64

#endif
