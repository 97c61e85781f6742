// SPDX-License-Identifier: MIT
// Projects the result of a sweep on nine spherical harmonics: the accumulated light volume that
// gathering reads.
//
//   c = P (L_b s^2)_b,   P (9 x 24) the projection of light that is constant over each bin
//
// docs/method.md, 'The sweep'.
//
// In:   sums         L s^2 [W/sr] of 3 channels and 24 bins (sweep_layout.h)
// Out:  accumulated  nine coefficients per cell and channel [W/sr], any layout, from channel
//                    `first` on
// From the host (host/pipeline/sweep/sweep_literals.cpp): CLPV_PROJECTION, P by folded bins
// (mirrored_bins.h). A work-item computes a tile of W x W cells of a slice and channel.
#include "volume/coefficients.h"
#include "shared/sweep.h"
#include "sweep/mirrored_bins.h"
#include "sweep/sweep_tiles.h"
#include "volume/light.h"

__constant const float projection[CLPV_SWEEP_BINS][CLPV_N] = CLPV_PROJECTION;

// P L
CLPV_INLINE Coefficients project_bins(const Bins bins) {
  const Bins folded = fold_bins(bins);
  Coefficients c = zero_coefficients();
#pragma unroll
  for (int b = 0; b < CLPV_SWEEP_BINS; ++b) c = add_row(c, folded.c[b], projection[b]);
  return c;
}

// Joins two channels of a white furnace in the first: S, whose border is dark, and S + B with a
// white one. The part of B that walls let through counts as closed. The limit is 1 where surfaces
// do not block light, so that their light adds up.
//
//   F = min(CLPV_MOST_WHITE, S + min(B, 2 max(0, B - CLPV_LEAST_OPEN)))
__kernel void join_furnace(CLPV_BUFFER_OUT sums) {
  const int at = W * (int)get_global_id(0), volumes = CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;
  if (at >= volumes) return;
  const realW surfaces = read_numbers(sums, at),
              border = read_numbers(sums + volumes, at) - surfaces;
  const realW open = fmin(border, 2.0f * fmax(border - CLPV_LEAST_OPEN, ZERO));
  write_numbers(sums, at, fmin((realW)(CLPV_MOST_WHITE), surfaces + open));
}

__kernel void sweep_collect(CLPV_BUFFER_IN sums, CLPV_VOLUME_OUT accumulated,
                            const int first) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  CLPV_BUFFER_IN volumes = sums + channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;
  SweepTile tiles[CLPV_AXIS_BINS];
  load_x_bins(volumes, x, y, z, tiles);
  for (int r = 0; r < W; ++r) {
    if (y + r >= CLPV_GRID) break;
    const Bins bins = load_bins(volumes, tiles, r, x, y + r, z);
    light_store(accumulated, first + channel, x, y + r, z, project_bins(bins));
  }
}
