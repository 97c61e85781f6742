// SPDX-License-Identifier: MIT
// How light at the borders of cascades lies in memory: what comes in at a sweep's sides (`border`), and what a coarser
// cascade keeps of its own for a finer one (`kept`).
//
// A grid has three upstream faces a direction and channel (number `swept` of them): the plane before the first one, and of
// each plane the row and the column before its first ones. The first is put where a sweep looks for the plane before;
// the sides of all of a bin's directions lie together, plane by plane, in the order in which a bin asks for them.
#ifndef CLPV_SWEEP_BORDER_H
#define CLPV_SWEEP_BORDER_H

#include "shared/sweep.h"
#include "sweep.h"

#define CLPV_SWEPT(bin, channel, part) ((((bin)*3) + (channel)) * CLPV_PARTS + (part))

#define CLPV_BORDER_PLANE 0
#define CLPV_BORDER_ROW 1
#define CLPV_BORDER_COLUMN 2

// The number of a side, beside a plane, at cell `at` of its row or column; eights of them start at cell -1.
CLPV_INLINE int clpv_side_at(const int swept, const int face, const int plane, const int at) {
  const int of_bin = 3 * CLPV_PARTS, planes = swept / of_bin * (CLPV_GRID + 2) + plane + 1;
  const int side = 2 * (planes * of_bin + swept % of_bin) + face - CLPV_BORDER_ROW;
  return side * CLPV_SWEEP_PITCH + 1 + at;
}

// Of a halo, (i, j): row and column of the face across planes, plane and column of that across rows, plane and row of that
// across columns.
// Of an axis: a halo is an argument by value, whose arrays are indexed by literals alone (region.h).
#define CLPV_HALO_FIRST(halo, axis) \
  ((axis) == 0 ? (halo).first[0] : ((axis) == 1 ? (halo).first[1] : (halo).first[2]))
CLPV_INLINE int clpv_halo_at(const ClpvSweepHalo halo, const int swept, const int face, const int layer, const int i,
                              const int j) {
  return (swept * 3 + face) * CLPV_SWEEP_HALO_FACE_OF(halo.side) +
         (layer * halo.side + i) * CLPV_SWEEP_HALO_PITCH_OF(halo.side) + j;
}

#endif
