// SPDX-License-Identifier: MIT
// Light swept through a cascade: for each direction once through the grid, upstream to downstream, plane by plane across
// the axis it is most along (discrete ordinates by short characteristics; docs/method.md, 'The sweep').
//
//   D = I + sum_k t_k T_k D_k,   k the four cells of the plane before that light comes from
//
// D [W/sr] is all light along the direction, I what was injected, T the transmittance of the link. Outside the grid D is the
// coarser cascade's light.
//
// In: I of each bin, in `injected` or `sources` (ClpvSweepBin); `links` (T); `border` (D beside the grid, sweep_border.h). Out:
// `sums`, which may be the same memory as `sources`, for each bin the sum of its directions by their shares; `kept`, D in the cells
// that a finer cascade's border is made of. `live` holds the last plane of each direction and channel, at first the one before the
// grid.
//
// Two forms. `sweep_bin`, for CPUs: a work-item is a bin, and walks all planes; rows downstream first, so that each plane
// replaces the one before in place and stays in cache. `sweep_plane`, for GPUs: a launch a plane, a work-item a cell (or
// CLPV_LANES) of a bin; planes of even and odd number have their places.
#include "prefetch.h"
#include "shared/sweep.h"
#include "sweep.h"
#include "sweep_border.h"

// CLPV_LANES cells of a plane, all channels and parts of a bin. `sources`: the buffer that the bin's are in. `from`: the plane
// before.
CLPV_INLINE void clpv_sweep_cells(const int b, const ClpvSweepBin bin, __constant const ClpvSweepDirection* direction,
                                  CLPV_BUFFER_IN sources, CLPV_BUFFER_IN links, CLPV_BUFFER_OUT sums,
                                  __global const float* from, __global float* to, const int plane, const int row,
                                  const int column) {
  const int source = bin.source + plane * bin.plane + row * bin.row + column;
  const int at = clpv_sweep_at(plane, row, column);
  const int here = CLPV_SWEPT(b, 0, 0) * CLPV_SWEEP_LIVE + clpv_live_at(row, column);
  __global const float* from0 = from + here;
  __global const float* from1 = from0 - bin.column_sign;
  __global const float* from2 = from0 - bin.row_sign * CLPV_SWEEP_PITCH;
  __global const float* from3 = from2 - bin.column_sign;
#if CLPV_BLOCKING
#define CLPV_LINK(k) const CLPV_REAL t##k = CLPV_SWEEP_LOAD(links + bin.links[k] * CLPV_SWEEP_VOLUME, at)
  CLPV_LINK(0);
  CLPV_LINK(1);
  CLPV_LINK(2);
  CLPV_LINK(3);
#define CLPV_TAP(k) (direction[part].taps[k] * t##k)
#else
#define CLPV_TAP(k) ((CLPV_REAL)(direction[part].taps[k]))
#endif
  CLPV_REAL injected[3], sum[3];
#pragma unroll
  for (int channel = 0; channel < 3; ++channel) {
    injected[channel] = CLPV_SWEEP_LOAD(sources + channel * bin.channel, source);
    sum[channel] = 0.0f;
  }
#pragma unroll
  for (int part = 0; part < CLPV_PARTS; ++part) {
    const CLPV_REAL w0 = CLPV_TAP(0), w1 = CLPV_TAP(1), w2 = CLPV_TAP(2), w3 = CLPV_TAP(3);
#pragma unroll
    for (int channel = 0; channel < 3; ++channel) {
      const int swept = CLPV_SWEPT(0, channel, part) * CLPV_SWEEP_LIVE;
      CLPV_REAL d = injected[channel];
      d = fma(w0, CLPV_LIVE_LOAD(from0, swept), d);
      d = fma(w1, CLPV_LIVE_LOAD(from1, swept), d);
      d = fma(w2, CLPV_LIVE_LOAD(from2, swept), d);
      d = fma(w3, CLPV_LIVE_LOAD(from3, swept), d);
      CLPV_LIVE_STORE(to + here, swept, d);
      sum[channel] = fma((CLPV_REAL)(direction[part].share), d, sum[channel]);
    }
  }
#pragma unroll
  for (int channel = 0; channel < 3; ++channel)
    CLPV_SWEEP_STORE(sums + (channel * CLPV_SWEEP_BINS + b) * CLPV_SWEEP_VOLUME, at, sum[channel]);
}

// Puts the light that comes in at the sides of a plane beside it, for the next one: cells of a row, and one of a column.
#define CLPV_UPSTREAM(sign) ((sign) > 0 ? -1 : CLPV_GRID)
CLPV_INLINE void clpv_border_row(CLPV_BUFFER_IN border, __global float* to, const ClpvSweepBin bin, const int swept,
                                 const int plane, const int column) {
  CLPV_LIVE_STORE(to, swept * CLPV_SWEEP_LIVE + clpv_live_at(CLPV_UPSTREAM(bin.row_sign), column),
                  CLPV_SWEEP_LOAD(border, clpv_side_at(swept, CLPV_BORDER_ROW, plane, column)));
}
CLPV_INLINE void clpv_border_column(CLPV_BUFFER_IN border, __global float* to, const ClpvSweepBin bin, const int swept,
                                    const int plane, const int row) {
  const CLPV_REAL light = CLPV_SWEEP_LOAD(border, clpv_side_at(swept, CLPV_BORDER_COLUMN, plane, row));
  to += swept * CLPV_SWEEP_LIVE + clpv_live_at(row, CLPV_UPSTREAM(bin.column_sign));
#if CLPV_LANES == 8
#define CLPV_DO(lane) \
  if (row + 0x##lane <= CLPV_GRID) to[0x##lane * CLPV_SWEEP_PITCH] = light.s##lane;
  CLPV_DO(0) CLPV_DO(1) CLPV_DO(2) CLPV_DO(3) CLPV_DO(4) CLPV_DO(5) CLPV_DO(6) CLPV_DO(7)
#undef CLPV_DO
#else
  *to = light;
#endif
}

// The lower of the two layers that a finer cascade's border wants across an axis of a bin.
#define CLPV_HALO_LAYER(halo, axis, sign)                                                                   \
  ((axis) == 0 ? ((sign) > 0 ? (halo).layers[0] : (halo).layers[1])                                         \
               : ((axis) == 1 ? ((sign) > 0 ? (halo).layers[2] : (halo).layers[3])                          \
                              : ((sign) > 0 ? (halo).layers[4] : (halo).layers[5])))

#define CLPV_SWEEP_ARGUMENTS                                                                                          \
  __constant const ClpvSweepBin *bins, __constant const ClpvSweepDirection *directions, CLPV_BUFFER_IN injected,      \
      CLPV_BUFFER_IN sources, CLPV_BUFFER_IN links, CLPV_BUFFER_IN border, const ClpvSweepHalo halo, __global float *live,                   \
      CLPV_BUFFER_OUT sums, CLPV_BUFFER_OUT kept

#if CLPV_WHOLE_BINS

// Keeps a row of the box, or a column, in eights: what lies beyond the grid is dark.
CLPV_INLINE void clpv_keep(const CLPV_REAL light, const int first, CLPV_BUFFER_OUT kept, const int at) {
  const int8 i = first + (int8)(0, 1, 2, 3, 4, 5, 6, 7);
  CLPV_SWEEP_STORE(kept, at, select((CLPV_REAL)(0.0f), light, i >= 0 && i < CLPV_GRID));
}
CLPV_INLINE void clpv_keep_row(const ClpvSweepHalo halo, __global const float* d, const int row, const int column,
                               CLPV_BUFFER_OUT kept, const int at) {
  for (int i = 0; i < halo.side; i += CLPV_LANES)
    clpv_keep(CLPV_LIVE_LOAD(d, clpv_live_at(row, column + i)), column + i, kept, at + i);
}
CLPV_INLINE void clpv_keep_column(const ClpvSweepHalo halo, __global const float* d, const int row, const int column,
                                  CLPV_BUFFER_OUT kept, const int at) {
  for (int i = 0; i < halo.side; i += CLPV_LANES) {
#define CLPV_OF(lane) d[clpv_live_at(clamp(row + i + lane, -1, CLPV_GRID), column)]
    const float8 light = {CLPV_OF(0), CLPV_OF(1), CLPV_OF(2), CLPV_OF(3), CLPV_OF(4), CLPV_OF(5), CLPV_OF(6), CLPV_OF(7)};
#undef CLPV_OF
    clpv_keep(light, row + i, kept, at + i);
  }
}

// Keeps what of a plane belongs to the halo, if anything.
CLPV_INLINE void clpv_keep_plane(const ClpvSweepHalo halo, const ClpvSweepBin bin, const int swept, const int plane,
                                 __global const float* d, CLPV_BUFFER_OUT kept) {
  const int p = plane - CLPV_HALO_FIRST(halo, bin.plane_axis);
  if (p < 0 || p >= halo.side) return;
  const int first_row = CLPV_HALO_FIRST(halo, bin.row_axis), first_column = CLPV_HALO_FIRST(halo, bin.column_axis);
  const int end = min(first_row + halo.side, CLPV_GRID);
  const int of_plane = plane - CLPV_HALO_LAYER(halo, bin.plane_axis, bin.plane_sign);
  for (int row = max(first_row, 0); row < end && (of_plane == 0 || of_plane == 1); ++row)
    clpv_keep_row(halo, d, row, first_column, kept,
                  clpv_halo_at(halo, swept, CLPV_BORDER_PLANE, of_plane, row - first_row, 0));
  for (int layer = 0; layer < 2; ++layer) {
    const int row = CLPV_HALO_LAYER(halo, bin.row_axis, bin.row_sign) + layer;
    if (row >= 0 && row < CLPV_GRID)
      clpv_keep_row(halo, d, row, first_column, kept, clpv_halo_at(halo, swept, CLPV_BORDER_ROW, layer, p, 0));
    const int column = CLPV_HALO_LAYER(halo, bin.column_axis, bin.column_sign) + layer;
    if (column >= 0 && column < CLPV_GRID)
      clpv_keep_column(halo, d, first_row, column, kept, clpv_halo_at(halo, swept, CLPV_BORDER_COLUMN, layer, p, 0));
  }
}

// What the next plane and the finer cascade want of a plane that is done.
CLPV_INLINE void clpv_finish_plane(const int b, const ClpvSweepBin bin, const ClpvSweepHalo halo, CLPV_BUFFER_IN border,
                                   const int dark, __global float* live, CLPV_BUFFER_OUT kept, const int plane) {
  const int first = CLPV_SWEPT(b, 0, 0);
  for (int swept = first; swept < first + 3 * CLPV_PARTS; ++swept) {
    clpv_keep_plane(halo, bin, swept, plane, live + swept * CLPV_SWEEP_LIVE, kept);
    for (int at = -1; at <= CLPV_GRID && !dark; at += CLPV_LANES) {
      clpv_border_row(border, live, bin, swept, plane, at);
      clpv_border_column(border, live, bin, swept, plane, at);
    }
  }
}

// Asks for a row of the next plane, in all that is read and written there. Processors ask for lines ahead by themselves, but not
// beyond a page of memory, and two planes of 32 x 32 halves fill one.
CLPV_INLINE void clpv_ask_for_row(const int b, const ClpvSweepBin bin, CLPV_BUFFER_IN sources, CLPV_BUFFER_IN links,
                                  CLPV_BUFFER_OUT sums, const int plane, const int row) {
  const int next = clamp(plane + bin.plane_sign, 0, CLPV_GRID - 1);
  for (int column = 0; column < CLPV_SWEEP_ROW; column += CLPV_LINE / (CLPV_STORAGE_HALF ? 2 : 4)) {
    const int source = bin.source + next * bin.plane + row * bin.row + column, at = clpv_sweep_at(next, row, column);
    for (int channel = 0; channel < 3; ++channel) {
      CLPV_PREFETCH(sources + channel * bin.channel + source);
      CLPV_PREFETCH(sums + (channel * CLPV_SWEEP_BINS + b) * CLPV_SWEEP_VOLUME + at);
    }
    for (int k = 0; k < 4 && CLPV_BLOCKING; ++k) CLPV_PREFETCH(links + bin.links[k] * CLPV_SWEEP_VOLUME + at);
  }
}

// `dark`: nothing comes in, and neither `border` nor what `live` holds at first is looked at.
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void sweep_bin(CLPV_SWEEP_ARGUMENTS, const int dark) {
  const int b = (int)get_global_id(0);
  const ClpvSweepBin bin = bins[b];
  __constant const ClpvSweepDirection* direction = directions + b * CLPV_PARTS;
  CLPV_BUFFER_IN light = bin.injected ? injected : sources;
  for (int i = 0; i < CLPV_SWEPT(1, 0, 0) * CLPV_SWEEP_LIVE && dark; i += CLPV_LANES)
    CLPV_LIVE_STORE(live, CLPV_SWEPT(b, 0, 0) * CLPV_SWEEP_LIVE + i, (CLPV_REAL)(0.0f));
  const int last_column = (CLPV_GRID - 1) / CLPV_LANES * CLPV_LANES;
  for (int p = 0; p < CLPV_GRID; ++p) {
    const int plane = bin.plane_sign > 0 ? p : CLPV_GRID - 1 - p;
    for (int r = 0; r < CLPV_GRID; ++r) {
      const int row = bin.row_sign > 0 ? CLPV_GRID - 1 - r : r;
      clpv_ask_for_row(b, bin, light, links, sums, plane, row);
      for (int c = 0; c <= last_column; c += CLPV_LANES) {
        const int column = bin.column_sign > 0 ? last_column - c : c;
        clpv_sweep_cells(b, bin, direction, light, links, sums, live, live, plane, row, column);
      }
    }
    clpv_finish_plane(b, bin, halo, border, dark, live, kept, plane);
  }
}

#else

// Keeps a cell of the halo, if it is one: in each face it belongs to.
CLPV_INLINE void clpv_keep_cell(const ClpvSweepHalo halo, const ClpvSweepBin bin, const int swept, const int plane,
                                const int row, const int column, const float d, CLPV_BUFFER_OUT kept) {
  const int p = plane - CLPV_HALO_FIRST(halo, bin.plane_axis), r = row - CLPV_HALO_FIRST(halo, bin.row_axis),
            c = column - CLPV_HALO_FIRST(halo, bin.column_axis);
  if (p < 0 || r < 0 || c < 0 || p >= halo.side || r >= halo.side || c >= halo.side) return;
  int layer = plane - CLPV_HALO_LAYER(halo, bin.plane_axis, bin.plane_sign);
  if (layer == 0 || layer == 1) CLPV_WRITE(kept, clpv_halo_at(halo, swept, CLPV_BORDER_PLANE, layer, r, c), d);
  layer = row - CLPV_HALO_LAYER(halo, bin.row_axis, bin.row_sign);
  if (layer == 0 || layer == 1) CLPV_WRITE(kept, clpv_halo_at(halo, swept, CLPV_BORDER_ROW, layer, p, c), d);
  layer = column - CLPV_HALO_LAYER(halo, bin.column_axis, bin.column_sign);
  if (layer == 0 || layer == 1) CLPV_WRITE(kept, clpv_halo_at(halo, swept, CLPV_BORDER_COLUMN, layer, p, r), d);
}

// `p`: the plane's number along the way.
__kernel void sweep_plane(CLPV_SWEEP_ARGUMENTS, const int p) {
  const int column = CLPV_LANES * (int)get_global_id(0), row = (int)get_global_id(1), b = (int)get_global_id(2);
  if (column >= CLPV_GRID || row >= CLPV_GRID) return;
  const ClpvSweepBin bin = bins[b];
  const int plane = bin.plane_sign > 0 ? p : CLPV_GRID - 1 - p;
  const int place = CLPV_SWEPT(CLPV_SWEEP_BINS, 0, 0) * CLPV_SWEEP_LIVE;  // from even planes to odd ones
  __global float* to = live + (p % 2) * place;
  __global const float* from = live + (1 - p % 2) * place;
  CLPV_BUFFER_IN light = bin.injected ? injected : sources;
  clpv_sweep_cells(b, bin, directions + b * CLPV_PARTS, light, links, sums, from, to, plane, row, column);
  const int first = CLPV_SWEPT(b, 0, 0), before = row == 0 ? -1 : row, after = row == CLPV_GRID - 1 ? CLPV_GRID : row;
  for (int swept = first; swept < first + 3 * CLPV_PARTS; ++swept) {
    for (int lane = 0; lane < CLPV_LANES; ++lane) {
      const int c = column + lane;
      if (c >= CLPV_GRID) break;
      clpv_keep_cell(halo, bin, swept, plane, row, c, to[swept * CLPV_SWEEP_LIVE + clpv_live_at(row, c)], kept);
      if (row == 0) clpv_border_row(border, to, bin, swept, plane, c);
    }
    if (column != 0) continue;
    for (int r = before; r <= after; ++r) clpv_border_column(border, to, bin, swept, plane, r);
  }
}

#endif
