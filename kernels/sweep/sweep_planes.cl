// SPDX-License-Identifier: MIT
// Sweeps one plane of every bin through a cascade, for GPUs whose local memory does not hold what
// sweep_groups.cl needs, and for media: a launch per plane, upstream to downstream; a work-item
// takes W cells of a plane and bin.
//
//   D = I + sum_k t_k T_k D_k,   L s^2 = sum_d share_d D_d
//
// Discrete ordinates by short characteristics (sweep_cell.h; docs/method.md, 'The sweep'). Planes
// of even and odd number have separate plane buffers, since work-items run in any order.
//
// Volumes have CLPV_GRID^3 numbers, laid out as in sweep_layout.h; an ordinate is a direction and
// channel.
// In:   coefficients, means, sources, lit   injected light I [W/sr] and where it is (BinSweep,
//                                           sweep_source.cl)
//       links              T in [0, 1], a volume for each axis and link
//       border             D [W/sr] in the cells beside the grid, for each ordinate
//                          (sweep_border.h)
//       plane_buffer       D [W/sr] in the previous plane, for each ordinate: even planes, then odd
//                          ones; before step 0 the odd ones hold the plane upstream of the grid
//       step               number of the plane along the bin's direction, 0 to CLPV_GRID - 1
// Out:  plane_buffer       D in this plane
//       sums               L s^2 [W/sr] of 3 channels and 24 bins
//       halo_light         D [W/sr] in the cells of `halo`: the boundary condition of the next
//                          finer cascade
#include "shared/sweep.h"
#include "sweep/halo_cells.h"

__kernel void sweep_plane(CLPV_SWEEP_PARAMETERS(step)) {
  const int column = W * (int)get_global_id(0), row = (int)get_global_id(1),
            b = (int)get_global_id(2);
  if (column >= CLPV_GRID || row >= CLPV_GRID) return;
  const ClpvSweepBin bin = bins[b];
  BinSweep s = CLPV_SWEEP_OF_BIN(b);
  select_bin(&s);
  const int plane = bin.plane_sign > 0 ? step : CLPV_GRID - 1 - step;
  // Numbers in all even planes.
  const int planes = ordinate_of(CLPV_SWEEP_BINS, 0, 0) * CLPV_BORDERED_PLANE;
  __global float* to = plane_buffer + (step % 2) * planes;
  __global const float* from = plane_buffer + (1 - step % 2) * planes;
  sweep_cells(&s, from, to, plane, row, column);
  const int first = ordinate_of(b, 0, 0);
  const int first_row = row == 0 ? -1 : row, last_row = row == CLPV_GRID - 1 ? CLPV_GRID : row;
  for (int ordinate = first; ordinate < first + 3 * CLPV_PARTS; ++ordinate) {
    for (int lane = 0; lane < W; ++lane) {
      const int c = column + lane;
      if (c >= CLPV_GRID) break;
      store_halo_cell(&s, halo, ordinate, (int3)(c, row, plane),
                      to[ordinate * CLPV_BORDERED_PLANE + plane_index(row, c)]);
      if (row == 0) copy_border_row(&s, to, ordinate, plane, c);
    }
    if (column != 0) continue;
    for (int r = first_row; r <= last_row; ++r) copy_border_column(&s, to, ordinate, plane, r);
  }
}
