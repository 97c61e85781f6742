// SPDX-License-Identifier: MIT
// What a sweep knows of its bins and directions (host/basis/sweep.hpp), as host and kernels both see it.
#ifndef CLPV_SHARED_SWEEP_H
#define CLPV_SHARED_SWEEP_H

#define CLPV_SWEEP_BINS 24

// Along w light goes from plane to plane; within a plane from row to row, within a row from column to column.
typedef struct {
  int plane_sign, row_sign, column_sign;  // 1: light goes upwards
  int plane_axis, row_axis, column_axis;  // 0 x, 1 y, 2 z
  int ways[4];                            // volumes of the transmittance from the cells 0, u, v, u and v aside
  int injected;                           // 1: its sources are read where they were injected; 0: from a volume of its own
  int source, channel, plane, row;        // where the sources of its first cell are; from there to the next channel, plane, row
} ClpvSweepBin;

#define CLPV_SIZEOF_SWEEP_BIN 60

typedef struct {
  float taps[4];       // of those four cells
  float share;         // solid angle over flux, of the bin's solid angle
  float from_coarser;  // what 1 of the coarser cascade's light is here
  int coarser;         // the part of the bin it comes from there
  int unused;
} ClpvSweepDirection;

#define CLPV_SIZEOF_SWEEP_DIRECTION 32

// The cells of a coarser cascade whose light a finer one's border is made of.
typedef struct {
  int first[3];   // cell of the box that holds them
  int side;       // cells along each of its edges; 0: there is no finer cascade
  int layers[6];  // the lower one of two layers along x, y, z: with light going upwards, downwards
} ClpvSweepShell;

#define CLPV_SIZEOF_SWEEP_SHELL 40

#endif
