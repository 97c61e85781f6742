// SPDX-License-Identifier: MIT
// Light that a medium scatters in the cells of a cascade: the source function J s^2 [W/sr] that a
// sweep reads (sweep_cell.h; docs/method.md, 'Media').
//
//   J_b = sigma_s / sigma_t (sum over lights of p_b(w) E + sum over bins b' of M_bb' L_b')
//
// J, L [W/m^2/sr]. E [W/m^2]: irradiance of a light, mean over eight points of the cell that lie in
// the medium; p_b [1/sr]: phase function from the light's direction w to the mean direction of bin
// b, over all bins scaled to an integral of 1; M (24 x 24): means of the phase function from bin to
// bin (host/basis/sweep.hpp).
//
// scatter_lights    adds the first sum for one light and one of its shadow maps
//   In:      grid, light, views, count, which, map   as in shade.cl, light scaled as volumes are
//            bins          mean direction of each bin
//   In, out: sources       J s^2 of 3 channels and 24 bins (sweep_layout.h)
// scatter_swept     adds the second sum, of swept light
//   In:      lit           J s^2 of the lights
//            swept         L s^2 [W/sr], as written by a sweep
//   Out:     sources
// From the host: CLPV_SCATTERING, M by folded bins (mirrored_bins.h). A work-item has a tile of
// W x W cells of a slice, in scatter_swept of one channel.
#include "lanes.h"
#include "gather/medium.h"
#include "raster/shadow.h"
#include "shared/grid.h"
#include "sweep/mirrored_bins.h"
#include "sweep/sweep_tiles.h"

// The light of a tile's row: irradiance in each channel, and the direction in which it travels.
typedef struct {
  realW irradiance[3];
  realW x, y, z;
} LightRow;

// Mean irradiance of the part of cell (x, y, z) in the medium, for each channel. Points nearer to a
// spot or point light than a quarter of a cell's edge count as that far away.
CLPV_INLINE void cell_irradiance(const ClpvGrid grid, const ClpvLight light, const ShadowMap shadow,
                                 const int x, const int y, const int z, float* red, float* green,
                                 float* blue) {
  const ClpvMedium medium = light.medium;
  const float cell = grid.cell;
  const float lower[3] = {grid.origin[0] + cell * (float)x, grid.origin[1] + cell * (float)y,
                          grid.origin[2] + cell * (float)z};
  *red = *green = *blue = 0.0f;
  for (int axis = 0; axis < 3; ++axis)
    if (lower[axis] >= medium.upper[axis] || lower[axis] + cell <= medium.lower[axis]) return;
  for (int point = 0; point < 8; point += W) {
    const intW corner = point + lane_numbers();
    realW points_at[3];
#pragma unroll
    for (int axis = 0; axis < 3; ++axis)
      points_at[axis] = clamp(
          lower[axis] + cell * (0.25f + 0.5f * to_realW(corner >> axis & 1)),
          (realW)(medium.lower[axis]), (realW)(medium.upper[axis]));
    const Vec points = vec(points_at[0], points_at[1], points_at[2]);
    Vec towards;
    Vec irradiance = light_irradiance(light, points, &towards);
    realW share = 0.125f * light_reaches(shadow, points);
    if (light.kind != CLPV_LIGHT_DIRECTIONAL) {
      const Vec offset = vec_minus(points, vec_of(light.position));
      const realW near = vec_dot(offset, offset) * (16.0f / (cell * cell));
      share *= near < ONE ? near : ONE;
    }
    irradiance = vec_times(irradiance, share);
    *red += sum_lanes(irradiance.x), *green += sum_lanes(irradiance.y),
        *blue += sum_lanes(irradiance.z);
  }
}

// Computes the light of each row of the tile from cell (x, y, z) on. Returns true if any cell
// receives light.
CLPV_INLINE bool light_tile(const ClpvGrid grid, const ClpvLight light, const ShadowMap shadow,
                            const int x, const int y, const int z, LightRow* rows) {
  float brightest = 0.0f;
  for (int r = 0; r < W; ++r) {
    float red[W], green[W], blue[W], along_x[W], along_y[W],
        along_z[W];
    for (int i = 0; i < W; ++i) {
      red[i] = green[i] = blue[i] = 0.0f;
      float3 along = (float3)(light.direction[0], light.direction[1], light.direction[2]);
      if (light.kind != CLPV_LIGHT_DIRECTIONAL) {
        const float3 centre = (float3)(x + i, y + r, z) + 0.5f;
        along = (float3)(grid.origin[0] - light.position[0], grid.origin[1] - light.position[1],
                         grid.origin[2] - light.position[2]) + grid.cell * centre;
        along /= fmax(length(along), 1e-6f * grid.cell);
      }
      along_x[i] = along.x, along_y[i] = along.y, along_z[i] = along.z;
      if (x + i >= CLPV_GRID || y + r >= CLPV_GRID) continue;
      cell_irradiance(grid, light, shadow, x + i, y + r, z, red + i, green + i, blue + i);
      brightest += red[i] + green[i] + blue[i];
    }
    const LightRow row = {{load_lanes(red), load_lanes(green), load_lanes(blue)},
                        load_lanes(along_x), load_lanes(along_y), load_lanes(along_z)};
    rows[r] = row;
  }
  return brightest > 0.0f;
}

// p_b for light along a row's directions, up to a factor.
CLPV_INLINE realW phase_to(const LightRow row, const float g, const float4 bin) {
  const realW d = 1.0f + g * g - 2.0f * g * (bin.x * row.x + bin.y * row.y + bin.z * row.z);
  return 1.0f / (d * sqrt(d));
}

CLPV_INLINE void add_to_row(CLPV_BUFFER_OUT volume, const int at, const realW added) {
  write_numbers(volume, at, read_numbers(volume, at) + added);
}

// Adds the tile from cell (x, y, z) on, whose rows lie along x, to a bin's volume.
CLPV_INLINE void add_tile(CLPV_BUFFER_OUT volume, const int bin, const SweepTile tile, const int x,
                          const int y, const int z) {
  if (bin < CLPV_AXIS_BINS) {
    const SweepTile columns = transpose_tile(tile);
    for (int r = 0; r < W && x + r < CLPV_GRID; ++r)
      add_to_row(volume, sweep_index(x + r, z, y), columns.row[r]);
    return;
  }
  for (int r = 0; r < W && y + r < CLPV_GRID; ++r)
    add_to_row(volume, bin_index(bin, x, y + r, z), tile.row[r]);
}

__kernel void scatter_lights(const ClpvGrid grid, const ClpvLight light,
                             __global const ClpvView* views, const uint count, const uint which,
                             __global const float* map, __constant const float4* bins,
                             CLPV_BUFFER_OUT sources) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1), z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  const ShadowMap shadow = {views, count, which, map};
  LightRow rows[W];
  if (!light_tile(grid, light, shadow, x, y, z, rows)) return;
  const float g = light.medium.anisotropy, area = grid.cell * grid.cell;
  for (int r = 0; r < W; ++r) {
    realW all = 0.0f;
    for (int b = 0; b < CLPV_SWEEP_BINS; ++b) all += phase_to(rows[r], g, bins[b]);
    const realW scale = area * (float)CLPV_SWEEP_BINS / (4.0f * M_PI_F * all);
    for (int channel = 0; channel < 3; ++channel)
      rows[r].irradiance[channel] *= scale * medium_albedo(light.medium, channel);
  }
  for (int b = 0; b < CLPV_SWEEP_BINS; ++b) {
    SweepTile phases;
    for (int r = 0; r < W; ++r) phases.row[r] = phase_to(rows[r], g, bins[b]);
    for (int channel = 0; channel < 3; ++channel) {
      SweepTile added;
      for (int r = 0; r < W; ++r) added.row[r] = phases.row[r] * rows[r].irradiance[channel];
      add_tile(sources + (channel * CLPV_SWEEP_BINS + b) * CLPV_SWEEP_VOLUME, b, added, x, y, z);
    }
  }
}

__constant const float scattering[3][CLPV_SWEEP_BINS] = CLPV_SCATTERING;

// M L. Light that is even or odd (bits of `odd`) under mirroring x, y and z scatters into light of
// the same symmetry.
CLPV_INLINE Bins scatter_bins(const Bins swept) {
  const Bins folded = fold_bins(swept);
  Bins scattered;
#pragma unroll
  for (int b = 0; b < CLPV_SWEEP_BINS; ++b) scattered.c[b] = 0.0f;
#pragma unroll
  for (int odd = 0; odd < 8; ++odd) {
#pragma unroll
    for (int axis = 0; axis < 3; ++axis) {
      realW sum = 0.0f;
#pragma unroll
      for (int from = 0; from < 3; ++from) {
        const int b = CLPV_AXIS_BINS * from + folded_number(from, odd);
        sum = fma((realW)(scattering[axis][b]), folded.c[b], sum);
      }
#pragma unroll
      for (int j = 0; j < CLPV_AXIS_BINS; ++j)
        scattered.c[CLPV_AXIS_BINS * axis + j] += folded_sign(j, folded_number(axis, odd)) * sum;
    }
  }
  return scattered;
}

__kernel void scatter_swept(const ClpvMedium medium, CLPV_BUFFER_IN lit, CLPV_BUFFER_IN swept,
                            CLPV_BUFFER_OUT sources) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  const int first = channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;
  const float albedo = medium_albedo(medium, channel);
  SweepTile tiles[CLPV_AXIS_BINS], before[CLPV_AXIS_BINS];
  load_x_bins(swept + first, x, y, z, tiles);
  load_x_bins(lit + first, x, y, z, before);
  for (int r = 0; r < W && y + r < CLPV_GRID; ++r) {
    const Bins added = scatter_bins(load_bins(swept + first, tiles, r, x, y + r, z));
    const Bins base = load_bins(lit + first, before, r, x, y + r, z);
#pragma unroll
    for (int b = 0; b < CLPV_SWEEP_BINS; ++b) {
      const realW sum = fma((realW)(albedo), added.c[b], base.c[b]);
      if (b < CLPV_AXIS_BINS) {
        tiles[b].row[r] = sum;
      } else {
        write_numbers(sources + first + b * CLPV_SWEEP_VOLUME, bin_index(b, x, y + r, z), sum);
      }
    }
  }
  for (int b = 0; b < CLPV_AXIS_BINS; ++b)
    store_x_tile(sources + first + b * CLPV_SWEEP_VOLUME, tiles[b], x, y, z);
}
