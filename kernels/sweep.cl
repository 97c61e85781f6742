// SPDX-License-Identifier: MIT
// Light swept through a cascade: for each direction once through the grid, upstream to downstream, plane by plane across
// the axis it is most along (discrete ordinates by short characteristics; docs/method.md, 'The sweep').
//
//   D = I + sum_k t_k T_k D_k,   k the four cells of the plane before that light comes from
//
// D [W/sr] is all light along the direction, I what was injected, T the transmittance of the way. Outside the grid D is the
// coarser cascade's light.
//
// In: `sources` (I of each bin), `ways` (T), `border` (D round the grid, sweep_border.cl). Out: `sums`, for each bin the sum
// of its directions by their shares; `shell`, D in the cells that a finer cascade's border is made of.
// `live` holds the last plane of each direction and channel; number (bin 3 + channel) CLPV_PARTS + part of them.
//
// Two forms. `sweep_bin`, for CPUs: a work-item is a bin, and walks all planes; rows downstream first, so that each plane
// replaces the one before in place and stays in cache. `sweep_plane`, for GPUs: a launch a plane, a work-item a cell (or
// CLPV_LANES) of a bin; planes of even and odd number have their places.
#include "shared/sweep.h"
#include "sweep.h"

#define CLPV_SWEPT(bin, channel, part) ((((bin)*3) + (channel)) * CLPV_PARTS + (part))

// The volume's place of cell (plane, row, column).
CLPV_INLINE int clpv_sweep_at(const ClpvSweepBin bin, const int plane, const int row, const int column) {
  return (plane + 1) * bin.plane_step + (row + 1) * bin.row_step + CLPV_SWEEP_FIRST + column;
}
CLPV_INLINE int clpv_live_at(const int row, const int column) {
  return (row + 1) * CLPV_SWEEP_PITCH + CLPV_SWEEP_FIRST + column;
}

// CLPV_LANES cells of a plane, all channels and parts of a bin. `from`: the plane before, `from_next` from a direction's to the next one's.
CLPV_INLINE void clpv_sweep_cells(const int b, const ClpvSweepBin bin, __constant const ClpvSweepDirection* direction,
                                  CLPV_BUFFER_IN sources, CLPV_BUFFER_IN ways, __global const float* from,
                                  const int from_next, __global float* to, CLPV_BUFFER_OUT sums, const int plane,
                                  const int row, const int column) {
  const int at = clpv_sweep_at(bin, plane, row, column), here = clpv_live_at(row, column);
  const int columns = bin.column_sign, live_rows = bin.row_sign * CLPV_SWEEP_PITCH;
#if CLPV_BLOCKING
  const CLPV_REAL t0 = CLPV_SWEEP_LOAD(ways + bin.ways[0] * CLPV_SWEEP_VOLUME, at);
  const CLPV_REAL t1 = CLPV_SWEEP_LOAD(ways + bin.ways[1] * CLPV_SWEEP_VOLUME, at);
  const CLPV_REAL t2 = CLPV_SWEEP_LOAD(ways + bin.ways[2] * CLPV_SWEEP_VOLUME, at);
  const CLPV_REAL t3 = CLPV_SWEEP_LOAD(ways + bin.ways[3] * CLPV_SWEEP_VOLUME, at);
#define CLPV_CARRIED(k, d) (t##k * (d))
#else
#define CLPV_CARRIED(k, d) (d)
#endif
  for (int channel = 0; channel < 3; ++channel) {
    const int volume = (channel * CLPV_SWEEP_BINS + b) * CLPV_SWEEP_VOLUME;
    const CLPV_REAL injected = CLPV_SWEEP_LOAD(sources + volume, at);
    CLPV_REAL sum = 0.0f;
#define CLPV_TAP(k) ((CLPV_REAL)(direction[part].taps[k]))
#pragma unroll
    for (int part = 0; part < CLPV_PARTS; ++part) {
      const int swept = CLPV_SWEPT(b, channel, part);
      __global const float* carried = from + swept * from_next + here;
      CLPV_REAL d = injected;
      d = fma(CLPV_TAP(0), CLPV_CARRIED(0, CLPV_LIVE_LOAD(carried, 0)), d);
      d = fma(CLPV_TAP(1), CLPV_CARRIED(1, CLPV_LIVE_LOAD(carried, -columns)), d);
      d = fma(CLPV_TAP(2), CLPV_CARRIED(2, CLPV_LIVE_LOAD(carried, -live_rows)), d);
      d = fma(CLPV_TAP(3), CLPV_CARRIED(3, CLPV_LIVE_LOAD(carried, -live_rows - columns)), d);
      CLPV_LIVE_STORE(to, swept * CLPV_SWEEP_LIVE + here, d);
      sum = fma((CLPV_REAL)(direction[part].share), d, sum);
    }
    CLPV_SWEEP_STORE(sums + volume, at, sum);
  }
}

// The faces of a border: the plane before the first one, and of each plane the row and the column before its first ones.
#define CLPV_BORDER_ROW 1
#define CLPV_BORDER_COLUMN 2
#define CLPV_BORDER(swept, face) (((swept)*3 + (face)) * CLPV_SWEEP_LIVE)
#define CLPV_UPSTREAM(sign) ((sign) > 0 ? -1 : CLPV_GRID)

// Puts the light that comes in at the border of a plane beside the plane, for the next one.
CLPV_INLINE void clpv_border_row(__global const float* border, __global float* to, const ClpvSweepBin bin,
                                 const int swept, const int plane, const int column) {
  to[swept * CLPV_SWEEP_LIVE + clpv_live_at(CLPV_UPSTREAM(bin.row_sign), column)] =
      border[CLPV_BORDER(swept, CLPV_BORDER_ROW) + clpv_live_at(plane, column)];
}
CLPV_INLINE void clpv_border_column(__global const float* border, __global float* to, const ClpvSweepBin bin,
                                    const int swept, const int plane, const int row) {
  to[swept * CLPV_SWEEP_LIVE + clpv_live_at(row, CLPV_UPSTREAM(bin.column_sign))] =
      border[CLPV_BORDER(swept, CLPV_BORDER_COLUMN) + clpv_live_at(plane, row)];
}

// A face of the shell: two layers of side x side cells, with room for eight lanes to read beyond.
#define CLPV_SHELL_PITCH(shell) ((shell).side + 8)
#define CLPV_SHELL_FACE(shell) (2 * (shell).side * CLPV_SHELL_PITCH(shell) + 8)

// Keeps a cell of the shell, if it is one: in each face it belongs to.
CLPV_INLINE void clpv_keep(const ClpvSweepShell shell, const ClpvSweepBin bin, const int swept, const int plane,
                           const int row, const int column, const float d, __global float* kept) {
  const int p = plane - shell.first[bin.plane_axis], r = row - shell.first[bin.row_axis],
            c = column - shell.first[bin.column_axis];
  if (p < 0 || r < 0 || c < 0 || p >= shell.side || r >= shell.side || c >= shell.side) return;
  __global float* face = kept + swept * 3 * CLPV_SHELL_FACE(shell);
#define CLPV_KEEP(coordinate, axis, sign, i, j)                                             \
  {                                                                                         \
    const int layer = coordinate - shell.layers[2 * (axis) + ((sign) > 0 ? 0 : 1)];         \
    if (layer == 0 || layer == 1) face[(layer * shell.side + i) * CLPV_SHELL_PITCH(shell) + j] = d; \
    face += CLPV_SHELL_FACE(shell);                                                         \
  }
  CLPV_KEEP(plane, bin.plane_axis, bin.plane_sign, r, c)
  CLPV_KEEP(row, bin.row_axis, bin.row_sign, p, c)
  CLPV_KEEP(column, bin.column_axis, bin.column_sign, p, r)
#undef CLPV_KEEP
}

#define CLPV_SWEEP_ARGUMENTS                                                                            \
  __constant const ClpvSweepBin *bins, __constant const ClpvSweepDirection *directions, CLPV_BUFFER_IN sources, \
      CLPV_BUFFER_IN ways, __global const float *border, const ClpvSweepShell shell, __global float *live,     \
      CLPV_BUFFER_OUT sums, __global float *kept

#if CLPV_WHOLE_BINS

// What the next plane and the finer cascade want of a plane that is done.
CLPV_INLINE void clpv_finish_plane(const int b, const ClpvSweepBin bin, const ClpvSweepShell shell,
                                   __global const float* border, __global float* live, __global float* kept,
                                   const int plane) {
  const int swept = CLPV_SWEPT(b, 0, 0);
  const int first_row = shell.first[bin.row_axis], first_column = shell.first[bin.column_axis];
  const int upstream_row = shell.layers[2 * bin.row_axis + (bin.row_sign > 0 ? 0 : 1)],
            upstream_column = shell.layers[2 * bin.column_axis + (bin.column_sign > 0 ? 0 : 1)];
  const int layer = plane - shell.layers[2 * bin.plane_axis + (bin.plane_sign > 0 ? 0 : 1)];
  const bool whole = layer == 0 || layer == 1;
  const int in_box = plane - shell.first[bin.plane_axis];
  for (int i = swept; i < swept + 3 * CLPV_PARTS; ++i) {
    __global const float* d = live + i * CLPV_SWEEP_LIVE;
    if (in_box >= 0 && in_box < shell.side) {
      for (int row = max(first_row, 0); row < min(first_row + shell.side, CLPV_GRID); ++row) {
        const bool rows = whole || row == upstream_row || row == upstream_row + 1;
        const int from = rows ? first_column : upstream_column, to = rows ? first_column + shell.side : upstream_column + 2;
        for (int column = max(from, 0); column < min(to, CLPV_GRID); ++column)
          clpv_keep(shell, bin, i, plane, row, column, d[clpv_live_at(row, column)], kept);
      }
    }
    for (int at = -1; at <= CLPV_GRID; ++at) {
      clpv_border_row(border, live, bin, i, plane, at);
      clpv_border_column(border, live, bin, i, plane, at);
    }
  }
}

__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void sweep_bin(CLPV_SWEEP_ARGUMENTS) {
  const int b = (int)get_global_id(0);
  const ClpvSweepBin bin = bins[b];
  __constant const ClpvSweepDirection* direction = directions + b * CLPV_PARTS;
  const int last_column = (CLPV_GRID - 1) / CLPV_LANES * CLPV_LANES;
  for (int p = 0; p < CLPV_GRID; ++p) {
    const int plane = bin.plane_sign > 0 ? p : CLPV_GRID - 1 - p;
    __global const float* from = p == 0 ? border : live;
    const int from_next = p == 0 ? CLPV_BORDER(1, 0) : CLPV_SWEEP_LIVE;
    for (int r = 0; r < CLPV_GRID; ++r) {
      const int row = bin.row_sign > 0 ? CLPV_GRID - 1 - r : r;
      for (int c = 0; c <= last_column; c += CLPV_LANES) {
        const int column = bin.column_sign > 0 ? last_column - c : c;
        clpv_sweep_cells(b, bin, direction, sources, ways, from, from_next, live, sums, plane, row, column);
      }
    }
    clpv_finish_plane(b, bin, shell, border, live, kept, plane);
  }
}

#else

// `p`: the plane's number along the way.
__kernel void sweep_plane(CLPV_SWEEP_ARGUMENTS, const int p) {
  const int column = CLPV_LANES * (int)get_global_id(0), row = (int)get_global_id(1), b = (int)get_global_id(2);
  if (column >= CLPV_GRID || row >= CLPV_GRID) return;
  const ClpvSweepBin bin = bins[b];
  const int plane = bin.plane_sign > 0 ? p : CLPV_GRID - 1 - p;
  const int place = CLPV_SWEPT(CLPV_SWEEP_BINS, 0, 0) * CLPV_SWEEP_LIVE;  // from even planes to odd ones
  __global float* to = live + (p % 2) * place;
  __global const float* from = p == 0 ? border : live + (1 - p % 2) * place;
  const int from_next = p == 0 ? CLPV_BORDER(1, 0) : CLPV_SWEEP_LIVE;
  clpv_sweep_cells(b, bin, directions + b * CLPV_PARTS, sources, ways, from, from_next, to, sums, plane, row, column);
  const int swept = CLPV_SWEPT(b, 0, 0), before = row == 0 ? -1 : row, after = row == CLPV_GRID - 1 ? CLPV_GRID : row;
  for (int i = swept; i < swept + 3 * CLPV_PARTS; ++i) {
    for (int lane = 0; lane < CLPV_LANES; ++lane) {
      const int c = column + lane;
      if (c >= CLPV_GRID) break;
      clpv_keep(shell, bin, i, plane, row, c, to[i * CLPV_SWEEP_LIVE + clpv_live_at(row, c)], kept);
      if (row == 0) clpv_border_row(border, to, bin, i, plane, c);
    }
    if (column != 0) continue;
    for (int r = before; r <= after; ++r) clpv_border_column(border, to, bin, i, plane, r);
  }
}

#endif
