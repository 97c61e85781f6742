// SPDX-License-Identifier: MIT
// Injects the texels of a surface as blockers into a geometry volume: sums over each cell's sorted
// texels.
//
//   blocking:  c = merge(c, sum B b(n))
//
// docs/method.md, 'Blockers'; Kaplanyan and Dachsbacher 2010. B is the blocked share of a surfel
// (find_cells.cl), b(n) the function of host/basis/transport.hpp. Sources of blockers see the same
// walls, so merge_blockers takes a maximum.
//
//   find_cells.cl    corner of each texel
//   sort_by_cell.cl  texels sorted by corner
//   sum_segments     sums of segments of a corner's texels (segments.h)
//   join_segments    sums of the corners that have several segments
//
// In:      injections     surfaces and their volumes (shared/view_injection.h)
//          sorted, count  (key, texel) of the sorted texels, and their number (sort_by_cell.cl)
//          normals        of every texel of the surface (surface.h)
//          shares         B of each sampled texel: every stride-th of every stride-th row
//                         (subsampling.h)
// In, out: volume         geometry volume
//          partials, firsts   sums and first texels of the corners with several segments
// From the host: CLPV_GRID, CLPV_SURFACE_PAPER, and the literals of blocking.h.
#include "inject/cell_keys.h"
#include "inject/blocking.h"
#include "raster/surface.h"
#include "shared/grid.h"
#include "shared/view_injection.h"
#include "shared/subsampling.h"
#include "volume/geometry.h"

enum {
  CLPV_CHANNELS = 1,
  CLPV_KEYS = (CLPV_GRID + 1) * (CLPV_GRID + 1) * (CLPV_GRID + 1),
};

// Sum of B b(n) over the texels of a corner, before project_blockers().
typedef struct {
  Coefficients channel[CLPV_CHANNELS];
} Sums;

typedef struct {
  __global const SurfaceTexel* normals;
  __global const float* shares;
  uint stride;
  __global const ClpvInjection* surface;
  uint number;
} Texels;

// Index of the i-th sampled texel of the surfaces.
static inline uint sampled_index(const Texels texels, const uint i) {
  const uint width = texels.surface->view.width, of_row = sampled_texels(width, texels.stride),
             row = i / of_row - texels.number *
                                    sampled_texels(texels.surface->view.height, texels.stride);
  return texels.surface->first + sampled_texel(row, texels.stride) * width +
         sampled_texel(i % of_row, texels.stride);
}

static inline Sums add_texel(Sums sums, const uint texel, const Texels texels CLPV_AND_H) {
  const float3 n = load_normal(texels.normals, sampled_index(texels, texel));
  sums.channel[0] = add_scaled(sums.channel[0], texels.shares[texel],
                               surfel_blocker(n.x, n.y, n.z CLPV_PASS_H));
  return sums;
}

// Merges A^-1 sums into a corner.
static inline void deliver(CLPV_VOLUME_OUT volume, const uint key, const Sums sums) {
  const int3 corner = cell_of(CLPV_GRID + 1, key);
  geometry_store(volume, 0, corner.x, corner.y, corner.z,
                 merge_blockers(project_blockers(sums.channel[0]),
                                geometry_load(volume, 0, corner.x, corner.y, corner.z)));
}

#include "inject/segments.h"

__kernel void sum_segments(__global const ClpvInjection* injections, __global const uint2* sorted,
                           __global const uint* count, const uint length, const uint blocks,
                           __global const SurfaceTexel* normals, __global const float* shares,
                           const uint stride, CLPV_VOLUME_OUT volume, __global float* partials,
                           __global uint* firsts CLPV_AND_H) {
  const Texels texels = {normals, shares, stride, injections, 0};
  sum_block(injections, sorted, count, length, blocks, texels, volume, partials,
            firsts CLPV_PASS_H);
}
