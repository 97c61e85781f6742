// SPDX-License-Identifier: MIT
// What a sweep knows of its bins and directions (host/basis/sweep.hpp), as host and kernels both see it.
#ifndef CLPV_SHARED_SWEEP_H
#define CLPV_SHARED_SWEEP_H

#define CLPV_SWEEP_BINS 24

// Along w light goes from plane to plane; within a plane from row to row, within a row from column to column.
typedef struct {
  int plane_sign, row_sign, column_sign;  // 1: light goes upwards
  int plane_axis, row_axis, column_axis;  // 0 x, 1 y, 2 z
  int links[4];                            // volumes of the transmittance from the cells 0, u, v, u and v aside
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
} ClpvSweepHalo;

#define CLPV_SIZEOF_SWEEP_SHELL 40

// How a sweep's numbers lie in memory (kernels/sweep.h), for a grid of n cells along each axis: numbers of a row, of a plane
// and a volume of planes; and of a row, a plane and a volume with a border of one cell all round.
#define CLPV_SWEEP_LINE 32  // between planes, and volumes
#define CLPV_SWEEP_FIRST 8  // from the start of a row to its first cell: rows of eight lanes stay aligned
#define CLPV_SWEEP_ROW_OF(n) (((n) + 7) / 8 * 8)
#define CLPV_SWEEP_PLANE_OF(n) ((n)*CLPV_SWEEP_ROW_OF(n) + CLPV_SWEEP_LINE)
#define CLPV_SWEEP_VOLUME_OF(n) ((n)*CLPV_SWEEP_PLANE_OF(n) + CLPV_SWEEP_LINE)
#define CLPV_SWEEP_PITCH_OF(n) (CLPV_SWEEP_ROW_OF(n) + CLPV_SWEEP_FIRST)
#define CLPV_SWEEP_LIVE_OF(n) (((n) + 2) * CLPV_SWEEP_PITCH_OF(n) + CLPV_SWEEP_FIRST)
#define CLPV_SWEEP_BORDERED_OF(n) (((n) + 2) * CLPV_SWEEP_LIVE_OF(n))

// A halo has faces of two layers of side x side cells; rows are whole eights, with room for one more.
#define CLPV_SWEEP_HALO_SIDE_OF(n) (((n) + 1) / 2 + 3)
#define CLPV_SWEEP_HALO_PITCH_OF(side) (((side) + 7) / 8 * 8 + 8)
#define CLPV_SWEEP_HALO_FACE_OF(side) (2 * (side)*CLPV_SWEEP_HALO_PITCH_OF(side) + 8)

#endif
