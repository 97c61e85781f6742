// SPDX-License-Identifier: MIT
// Memory layout of the boundary condition of a sweep: the border of a cascade, and the halo that a
// coarser cascade stores for a finer one.
//
// An ordinate is a direction and channel. Each has three upstream faces: the plane before the first
// one, which goes into the plane buffer, and per plane the row and the column upstream, which go
// into `border`. `border` stores the rows and columns of a bin's ordinates plane by plane, in the
// order in which sweep_bin reads them.
#pragma once

#include "shared/sweep.h"
#include "sweep/sweep_layout.h"

// Number of an ordinate.
CLPV_INLINE int ordinate_of(const int bin, const int channel, const int part) {
  return (bin * 3 + channel) * CLPV_PARTS + part;
}

enum {
  CLPV_BORDER_PLANE,
  CLPV_BORDER_ROW,
  CLPV_BORDER_COLUMN,
};

// Index in `border` of cell `at` (-1 to CLPV_GRID) of the row or column upstream of a plane. Groups
// of eight start at cell -1.
CLPV_INLINE int border_index(const int ordinate, const int face, const int plane, const int at) {
  const int per_bin = 3 * CLPV_PARTS, planes = ordinate / per_bin * (CLPV_GRID + 2) + plane + 1;
  const int side = 2 * (planes * per_bin + ordinate % per_bin) + face - CLPV_BORDER_ROW;
  return side * CLPV_SWEEP_PITCH + 1 + at;
}

// Selects x, y or z by axis, in place of an array: structs that kernels get by value have their
// arrays indexed only by literals (region.h).
CLPV_INLINE int along_axis(const int axis, const int x, const int y, const int z) {
  return axis == 0 ? x : (axis == 1 ? y : z);
}

// First cell of the halo along an axis.
CLPV_INLINE int halo_first(const ClpvSweepHalo halo, const int axis) {
  return along_axis(axis, halo.first[0], halo.first[1], halo.first[2]);
}

// Lower one of the two halo layers across an axis, for light along `sign`.
CLPV_INLINE int halo_layer(const ClpvSweepHalo halo, const int axis, const int sign) {
  return sign > 0 ? along_axis(axis, halo.layers[0], halo.layers[2], halo.layers[4])
                  : along_axis(axis, halo.layers[1], halo.layers[3], halo.layers[5]);
}

// Index in a halo. (i, j) is (row, column) in CLPV_BORDER_PLANE, (plane, column) in CLPV_BORDER_ROW
// and (plane, row) in CLPV_BORDER_COLUMN.
CLPV_INLINE int halo_index(const ClpvSweepHalo halo, const int ordinate, const int face,
                           const int layer, const int i, const int j) {
  return (ordinate * 3 + face) * halo_face_size(halo.side) +
         (layer * halo.side + i) * halo_pitch(halo.side) + j;
}
