// SPDX-License-Identifier: MIT
// Injects the texels of a surface into a volume, as light or as blockers: sums over each cell's
// sorted texels.
//
//   light (CLPV_GEOMETRY 0):     c += (P / pi) c(n)
//   blocking (CLPV_GEOMETRY 1):  c = merge(c, sum B b(n))
//
// docs/method.md, 'Injection' and 'Blockers'; Kaplanyan and Dachsbacher 2010. P [W] is the flux of
// a texel's virtual point light, c(n) the clamped cosine about its normal, B the blocked share
// (find_cells.cl) and b(n) the function of host/basis/blocking.hpp. c(n) = A^-1 alpha(n) is linear
// in alpha: a cell sums weighted alphas, and A^-1 is applied once per cell. Sources of blockers see
// the same walls, so merge_blockers takes a maximum.
//
//   find_cells.cl    cell of each texel
//   sort_by_cell.cl  texels sorted by cell
//   sum_segments     sums of segments: up to `length` texels of a cell, counted from the cell's
//                    first texel
//   join_segments    sums of the cells that have several segments
//
// A cell's sum depends only on its own texels, bit by bit.
//
// In:      sorted, count  (key, texel) of the sorted texels, and their number (sort_by_cell.cl)
//          normals, colours, colour_scale   surface texels, flux [W] (surface.h); blocking: normals
//                                           and shares
//          width, stride  blocking: texels of a row, and the subsampling (shared/thinned.h)
// In, out: volume         light or geometry volume
//          partials, firsts   sums and first texels of the cells with several segments
// From the host: CLPV_GRID, CLPV_GEOMETRY, CLPV_UNIT_FLUX, CLPV_SURFACE_PAPER, and the text of
// host/codegen/inject_source.hpp. With rotated lobes the look-up table is the last argument of
// sum_segments (CLPV_AND_TABLE).
#include "inject/cell_keys.h"
#include "volume/coefficients.h"
#if CLPV_GEOMETRY
#include "inject/blocking.h"
#else
#include "inject/lobe.h"
#endif
#include "inject/add_to_volume.h"
#include "shared/thinned.h"
#include "raster/surface.h"

#define CLPV_NO_SEGMENT 0xffffffffu

// Parameters of the surface that texels are read from. Blocking takes every stride-th texel
// (shared/thinned.h) of rows of `width`, each with its share (find_cells.cl); light takes every
// texel.
#if CLPV_GEOMETRY
#define CLPV_TEXELS                                                                     \
  __global const SurfaceTexel *normals, __global const float *shares, const uint width, \
      const uint stride
#define CLPV_PASS_TEXELS normals, shares, width, stride
#else
#define CLPV_TEXELS                                                           \
  __global const SurfaceTexel *normals, __global const SurfaceTexel *colours, \
      const float colour_scale
#define CLPV_PASS_TEXELS normals, colours, colour_scale
#endif

static inline Sums no_sums(void) {
  Sums sums;
#pragma unroll
  for (int c = 0; c < CLPV_CHANNELS; ++c) sums.channel[c] = zero_coefficients();
  return sums;
}

#if CLPV_GEOMETRY

// Index of the i-th texel taken from a surface with rows of `width` texels.
static inline uint taken_index(const uint width, const uint i, const uint stride) {
  const uint of_row = CLPV_TAKEN(width, stride);
  return CLPV_TAKEN_TEXEL(i / of_row, stride) * width + CLPV_TAKEN_TEXEL(i % of_row, stride);
}

static inline Sums add_texel(Sums sums, const uint texel, CLPV_TEXELS CLPV_AND_TABLE) {
  const float3 n = load_normal(normals, taken_index(width, texel, stride));
  sums.channel[0] =
      add_scaled(sums.channel[0], shares[texel], surfel_blocker(n.x, n.y, n.z CLPV_PASS_TABLE));
  return sums;
}

#else

static inline Sums add_texel(Sums sums, const uint texel, CLPV_TEXELS CLPV_AND_TABLE) {
  const float3 n = load_normal(normals, texel);
  const Coefficients lobe = lobe_integrals(n.x, n.y, n.z CLPV_PASS_TABLE);
  float3 flux = load_colour(colours, texel, colour_scale);
#if CLPV_UNIT_FLUX
  flux *= M_PI_F / lobe_flux(lobe);
#endif
  sums.channel[0] = add_scaled(sums.channel[0], flux.x, lobe);
  sums.channel[1] = add_scaled(sums.channel[1], flux.y, lobe);
  sums.channel[2] = add_scaled(sums.channel[2], flux.z, lobe);
  return sums;
}

#endif

static inline void store_sums(__global float* partials, const uint slot, const Sums sums) {
  __global float* to = partials + slot * (CLPV_CHANNELS * CLPV_N);
#pragma unroll
  for (int c = 0; c < CLPV_CHANNELS; ++c) {
#pragma unroll
    for (int i = 0; i < CLPV_N; ++i) to[c * CLPV_N + i] = sums.channel[c].c[i];
  }
}

static inline Sums add_stored(Sums sums, __global const float* partials, const uint slot) {
  __global const float* from = partials + slot * (CLPV_CHANNELS * CLPV_N);
#pragma unroll
  for (int c = 0; c < CLPV_CHANNELS; ++c) {
#pragma unroll
    for (int i = 0; i < CLPV_N; ++i) sums.channel[c].c[i] += from[c * CLPV_N + i];
  }
  return sums;
}

// Index of the first sorted texel of cell `key`, by binary search in [0, before]. Texel `before`
// belongs to the cell.
static inline uint first_of_cell(__global const uint2* sorted, const uint key, const uint before) {
  uint low = 0, high = before;
  while (low < high) {
    const uint middle = low + (high - low) / 2;
    if (sorted[middle].x < key) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

// Index at which the first segment of a block starts: where a cell starts, or a whole number of
// segments later.
static inline uint first_segment(__global const uint2* sorted, const uint total, const uint length,
                                 const uint block, bool* starts_cell) {
  uint at = block * length;
  const uint key = sorted[at].x;
  *starts_cell = true;
  if (at == 0 || sorted[at - 1].x != key) return at;
  const uint begin = first_of_cell(sorted, key, at);
  const uint boundary = begin + (at - begin + length - 1) / length * length;
  while (at < boundary && at < total && sorted[at].x == key) ++at;
  *starts_cell = !(at == boundary && at < total && sorted[at].x == key);
  return at;
}

// Sums the segments that start in a block of `length` sorted texels; a work-item per block. A cell
// of one segment is delivered at once. Of a longer cell, firsts[block] is the index of its first
// texel; partials[2 block + 1] holds the sums of its first segment, partials[2 block] those of a
// later one. At most one of each starts in a block.
__kernel void sum_segments(__global const uint2* sorted, __global const uint* count,
                           const uint length, const uint blocks, CLPV_TEXELS,
                           CLPV_VOLUME_OUT volume, __global float* partials,
                           __global uint* firsts CLPV_AND_TABLE) {
  const uint block = get_global_id(0);
  if (block >= blocks) return;
  firsts[block] = CLPV_NO_SEGMENT;
  const uint total = count[0];
  const uint stop = min((block + 1) * length, total);
  if (block * length >= stop) return;
  bool starts_cell;
  uint at = first_segment(sorted, total, length, block, &starts_cell);
  while (at < stop) {
    const uint key = sorted[at].x;
    const uint first = at, end = min(at + length, total);
    Sums sums = no_sums();
    for (; at < end && sorted[at].x == key; ++at)
      sums = add_texel(sums, sorted[at].y, CLPV_PASS_TEXELS CLPV_PASS_TABLE);
    const bool ends_cell = at == total || sorted[at].x != key;
    if (starts_cell && ends_cell) {
      deliver(volume, key, sums);
    } else {
      store_sums(partials, 2 * block + (starts_cell ? 1 : 0), sums);
      if (starts_cell) firsts[block] = first;
    }
    starts_cell = true;
  }
}

// Delivers the cells of several segments; a work-item per block, for the cell whose first segment
// starts in it.
__kernel void join_segments(__global const uint2* sorted, __global const uint* count,
                            const uint length, const uint blocks, CLPV_VOLUME_OUT volume,
                            __global const float* partials, __global const uint* firsts) {
  const uint block = get_global_id(0);
  if (block >= blocks) return;
  uint at = firsts[block];
  if (at == CLPV_NO_SEGMENT) return;
  const uint key = sorted[at].x, total = count[0];
  Sums sums = add_stored(no_sums(), partials, 2 * block + 1);
  uint slot = 2 * block + 2;
  for (at += length; at < total && sorted[at].x == key; at += length, slot += 2) {
    sums = add_stored(sums, partials, slot);
  }
  deliver(volume, key, sums);
}
