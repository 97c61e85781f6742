// SPDX-License-Identifier: MIT
// Injects the texels of a reflective shadow map into a light volume: sums over each cell's sorted
// texels.
//
//   light:     c += (P / pi) c(n)
//
// docs/method.md, 'Injection'; Kaplanyan and Dachsbacher 2010. P [W] is the flux of a texel's
// virtual point light, c(n) the clamped cosine about its normal. c(n) = A^-1 alpha(n) is linear in
// alpha: a cell sums P alpha, and A^-1 is applied once per cell.
//
//   find_cells.cl    cell of each texel
//   sort_by_cell.cl  texels sorted by cell
//   sum_segments     sums of segments of a cell's texels (segments.h)
//   join_segments    sums of the cells that have several segments
//
// In:      injections     surfaces and their volumes (shared/view_injection.h)
//          sorted, count  (key, texel) of the sorted texels, and their number (sort_by_cell.cl)
//          normals, colours   surface texels, flux [W] (surface.h)
// In, out: volume         light volumes
//          partials, firsts   sums and first texels of the cells with several segments
// From the host: CLPV_GRID, CLPV_UNIT_FLUX 1: lobes are scaled to the exact flux,
// CLPV_SURFACE_PAPER, and the literals of basis/lobe.h.
#include "inject/cell_keys.h"
#include "basis/lobe.h"
#include "raster/surface.h"
#include "shared/grid.h"
#include "shared/view_injection.h"
#include "volume/light.h"

enum { CLPV_CHANNELS = 3, CLPV_KEYS = CLPV_GRID * CLPV_GRID * CLPV_GRID };

// Sums of P alpha over the texels of a cell, for each channel.
typedef struct {
  Coefficients channel[CLPV_CHANNELS];
} Sums;

typedef struct {
  __global const SurfaceTexel* normals;
  __global const SurfaceTexel* colours;
  __global const ClpvInjection* surface;
  uint number;
} Texels;

static inline Sums add_texel(Sums sums, const uint i, const Texels texels CLPV_AND_H) {
  const uint texel = texels.surface->first + i -
                     texels.number * texels.surface->view.width * texels.surface->view.height;
  const float3 n = load_normal(texels.normals, texel);
  const Coefficients lobe = lobe_integrals(n.x, n.y, n.z CLPV_PASS_H);
  float3 flux = load_colour(texels.colours, texel, texels.surface->colour_scale);
  if (CLPV_UNIT_FLUX) flux *= M_PI_F / lobe_flux(lobe);
  sums.channel[0] = add_scaled(sums.channel[0], flux.x, lobe);
  sums.channel[1] = add_scaled(sums.channel[1], flux.y, lobe);
  sums.channel[2] = add_scaled(sums.channel[2], flux.z, lobe);
  return sums;
}

// Adds (1 / pi) A^-1 sums to a cell.
static inline void deliver(CLPV_VOLUME_OUT volume, const uint key, const Sums sums) {
  const int3 cell = cell_of(CLPV_GRID, key);
#pragma unroll
  for (int c = 0; c < CLPV_CHANNELS; ++c)
    light_store(volume, c, cell.x, cell.y, cell.z,
                add_scaled(light_load(volume, c, cell.x, cell.y, cell.z), M_1_PI_F,
                           project_sum(sums.channel[c])));
}

#include "inject/segments.h"

__kernel void sum_segments(__global const ClpvInjection* injections, __global const uint2* sorted,
                           __global const uint* count, const uint length, const uint blocks,
                           __global const SurfaceTexel* normals,
                           __global const SurfaceTexel* colours, CLPV_VOLUME_OUT volume,
                           __global float* partials, __global uint* firsts CLPV_AND_H) {
  const Texels texels = {normals, colours, injections, 0};
  sum_block(injections, sorted, count, length, blocks, texels, volume, partials,
            firsts CLPV_PASS_H);
}
