// SPDX-License-Identifier: MIT
// Sweeps whole bins through a cascade, for CPUs: a work-item takes one bin of directions through
// all planes, upstream to downstream.
//
//   D = I + sum_k t_k T_k D_k,   L s^2 = sum_d share_d D_d
//
// Discrete ordinates by short characteristics (sweep_cell.h; docs/method.md, 'The sweep'). Within a
// plane the row farthest downstream comes first. Each plane therefore overwrites the previous one
// in place and stays in cache.
//
// Volumes have CLPV_GRID^3 numbers, laid out as in sweep_layout.h; an ordinate is a direction and
// channel.
// In:   coefficients, means, sources, lit   injected light I [W/sr] and where it is (BinSweep,
//                                           sweep_source.cl)
//       links              T in [0, 1], a volume for each axis and link
//       border             D [W/sr] in the cells beside the grid, for each ordinate
//                          (sweep_border.h); unused if `dark`
//       plane_buffer       D [W/sr] in the plane upstream of the grid, for each ordinate; unused if
//                          `dark`
// Out:  plane_buffer       D in the last plane
//       sums               L s^2 [W/sr] of 3 channels and 24 bins
//       halo_light         D [W/sr] in the cells of `halo`: the boundary condition of the next
//                          finer cascade
// dark: 1 if no light enters at the border. `inside`, `scattered`: with CLPV_MEDIUM (BinSweep).
#include "prefetch.h"
#include "shared/sweep.h"
#include "sweep/sweep_cell.h"

// Stores eight numbers of the halo; cells outside the grid are dark.
CLPV_INLINE void store_halo(const realW light, const int first, CLPV_BUFFER_OUT halo_light,
                            const int at) {
  const intW i = first + lane_numbers();
  write_numbers(halo_light, at, select(ZERO, light, i >= 0 && i < CLPV_GRID));
}
CLPV_INLINE void store_halo_row(const ClpvSweepHalo halo, __global const float* d, const int row,
                                const int column, CLPV_BUFFER_OUT halo_light, const int at) {
  for (int i = 0; i < halo.side; i += W)
    store_halo(load_lanes(d + plane_index(row, column + i)), column + i, halo_light, at + i);
}
CLPV_INLINE void store_halo_column(const ClpvSweepHalo halo, __global const float* d, const int row,
                                   const int column, CLPV_BUFFER_OUT halo_light, const int at) {
  for (int i = 0; i < halo.side; i += W) {
    float light[W];
#pragma unroll
    for (int lane = 0; lane < W; ++lane)
      light[lane] = d[plane_index(clamp(row + i + lane, -1, CLPV_GRID), column)];
    store_halo(load_lanes(light), row + i, halo_light, at + i);
  }
}

// Stores the halo's cells of a plane. `d`: the ordinate's plane buffer.
CLPV_INLINE void store_halo_plane(const BinSweep* s, const ClpvSweepHalo halo, const int ordinate,
                                  const int plane, __global const float* d) {
  const ClpvSweepBin bin = s->bin;
  const int p = plane - halo_first(halo, bin.plane_axis);
  if (p < 0 || p >= halo.side) return;
  const int first_row = halo_first(halo, bin.row_axis),
            first_column = halo_first(halo, bin.column_axis);
  const int end = min(first_row + halo.side, CLPV_GRID);
  const int plane_layer = plane - halo_layer(halo, bin.plane_axis, bin.plane_sign);
  for (int row = max(first_row, 0); row < end && (plane_layer == 0 || plane_layer == 1); ++row)
    store_halo_row(halo, d, row, first_column, s->halo_light,
                   halo_index(halo, ordinate, CLPV_BORDER_PLANE, plane_layer, row - first_row, 0));
  for (int layer = 0; layer < 2; ++layer) {
    const int row = halo_layer(halo, bin.row_axis, bin.row_sign) + layer;
    if (row >= 0 && row < CLPV_GRID)
      store_halo_row(halo, d, row, first_column, s->halo_light,
                     halo_index(halo, ordinate, CLPV_BORDER_ROW, layer, p, 0));
    const int column = halo_layer(halo, bin.column_axis, bin.column_sign) + layer;
    if (column >= 0 && column < CLPV_GRID)
      store_halo_column(halo, d, first_row, column, s->halo_light,
                        halo_index(halo, ordinate, CLPV_BORDER_COLUMN, layer, p, 0));
  }
}

// Ends a plane: stores its part of the halo, and copies the boundary condition that the next plane
// reads.
CLPV_INLINE void end_plane(const BinSweep* s, const ClpvSweepHalo halo, const int dark,
                           __global float* plane_buffer, const int plane) {
  const int first = ordinate_of(s->number, 0, 0);
  for (int ordinate = first; ordinate < first + 3 * CLPV_PARTS; ++ordinate) {
    store_halo_plane(s, halo, ordinate, plane, plane_buffer + ordinate * CLPV_BORDERED_PLANE);
    for (int at = -1; at <= CLPV_GRID && !dark; at += W) {
      copy_border_row(s, plane_buffer, ordinate, plane, at);
      copy_border_column(s, plane_buffer, ordinate, plane, at);
    }
  }
}

// Prefetches a row of the next plane in all volumes. Hardware prefetch stops at the end of a page,
// and two planes of 32 x 32 halves fill one.
CLPV_INLINE void prefetch_row(const BinSweep* s, const int plane, const int row) {
  const ClpvSweepBin bin = s->bin;
  const int next = clamp(plane + bin.plane_sign, 0, CLPV_GRID - 1);
  for (int column = 0; column < CLPV_SWEEP_ROW; column += CLPV_LINE / (CLPV_STORAGE_HALF ? 2 : 4)) {
    const int at = sweep_index(next, row, column);
    for (int channel = 0; channel < 3; ++channel)
      prefetch_line(s->sums + (channel * CLPV_SWEEP_BINS + s->number) * CLPV_SWEEP_VOLUME + at);
    for (int k = 0; k < 4 && CLPV_BLOCKING; ++k)
      prefetch_line(s->links + bin.links[k] * CLPV_SWEEP_VOLUME + at);
  }
}

__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void sweep_bin(
    CLPV_SWEEP_PARAMETERS(dark)) {
  const int b = (int)get_global_id(0);
  const ClpvSweepBin bin = bins[b];
  BinSweep s = CLPV_SWEEP_OF_BIN(b);
  select_bin(&s);
  for (int i = 0; i < ordinate_of(1, 0, 0) * CLPV_BORDERED_PLANE && dark; i += W)
    store_lanes(ZERO, plane_buffer + ordinate_of(b, 0, 0) * CLPV_BORDERED_PLANE + i);
  const int last_column = (CLPV_GRID - 1) / W * W;
  for (int p = 0; p < CLPV_GRID; ++p) {
    const int plane = bin.plane_sign > 0 ? p : CLPV_GRID - 1 - p;
    for (int r = 0; r < CLPV_GRID; ++r) {
      const int row = bin.row_sign > 0 ? CLPV_GRID - 1 - r : r;
      prefetch_row(&s, plane, row);
      for (int c = 0; c <= last_column; c += W) {
        const int column = bin.column_sign > 0 ? last_column - c : c;
        sweep_cells(&s, plane_buffer, plane_buffer, plane, row, column);
      }
    }
    end_plane(&s, halo, dark, plane_buffer, plane);
  }
}
