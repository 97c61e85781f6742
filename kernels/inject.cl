// SPDX-License-Identifier: MIT
// Injection: what a view sees becomes light or blocking in the cells of a volume (docs/method.md, 'Injection').
//
// CLPV_GEOMETRY 0, light: a texel is a virtual point light of flux P [W]; its cell gains (P/pi) c(n), c(n) the clamped
// cosine round n. CLPV_GEOMETRY 1, blocking: a texel is a surfel of area A; the corner nearest to it gains A/s^2 of what
// host/basis/blocking.hpp says of n. All surfaces injected see the same walls: clpv_merge, not a sum.
//
// c(n) = A^-1 alpha(n) is linear in alpha: a cell sums its texels' weighted alpha, and the matrix comes once a cell.
// Three steps: find_cells.cl gives every texel its cell; sort_by_cell.cl sorts them; sum_segments and join_segments
// add up each cell's texels in their order in the surface. A cell's sum depends on its own texels alone, to the bit:
// it is made of segments counted from the cell's first texel.
//
// From the host: CLPV_GRID, CLPV_GEOMETRY, CLPV_UNIT_FLUX, CLPV_SURFACE_PAPER; as text what
// host/codegen/inject_source.hpp lists. Where lobes are rotated, sum_segments has the table as its last argument.
#include "cell_keys.h"
#include "coefficients.h"
#include "add_to_volume.h"
#include "shared/thinned.h"
#include "surface.h"

#define CLPV_NO_SEGMENT 0xffffffffu

// What the taken texels are summed from. Blocking takes every stride-th texel (shared/thinned.h) of rows of `width`, each
// with its share (find_cells.cl); light takes every one.
#if CLPV_GEOMETRY
#define CLPV_TEXELS \
  __global const SurfaceTexel *normals, __global const float *shares, const uint width, const uint stride
#define CLPV_PASS_TEXELS normals, shares, width, stride
#else
#define CLPV_TEXELS \
  __global const SurfaceTexel *normals, __global const SurfaceTexel *colours, const float colour_scale
#define CLPV_PASS_TEXELS normals, colours, colour_scale
#endif

static inline Sums no_sums(void) {
  Sums sums;
#define CLPV_DO(i) sums.k0.c##i = 0.0f;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
#if !CLPV_GEOMETRY
  sums.k1 = sums.k0;
  sums.k2 = sums.k0;
#endif
  return sums;
}

static inline Coefficients add_lobe(Coefficients sum, const float weight, const Coefficients lobe) {
#define CLPV_DO(i) sum.c##i = fma(weight, lobe.c##i, sum.c##i);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return sum;
}

#if CLPV_GEOMETRY

// Where the i-th taken texel of a surface of rows of `width` texels is.
static inline uint taken_index(const uint width, const uint i, const uint stride) {
  const uint of_row = CLPV_TAKEN(width, stride);
  return CLPV_TAKEN_TEXEL(i / of_row, stride) * width + CLPV_TAKEN_TEXEL(i % of_row, stride);
}

static inline Sums add_texel(Sums sums, const uint texel, CLPV_TEXELS CLPV_AND_TABLE) {
  const float3 n = clpv_load_normal(normals, taken_index(width, texel, stride));
  sums.k0 = add_lobe(sums.k0, shares[texel], clpv_blocker(n.x, n.y, n.z CLPV_PASS_TABLE));
  return sums;
}

#else

static inline Sums add_texel(Sums sums, const uint texel, CLPV_TEXELS CLPV_AND_TABLE) {
  const float3 n = clpv_load_normal(normals, texel);
  const Coefficients lobe = clpv_lobe_integrals(n.x, n.y, n.z CLPV_PASS_TABLE);
  float3 flux = clpv_load_colour(colours, texel, colour_scale);
#if CLPV_UNIT_FLUX
  flux *= M_PI_F / clpv_flux(lobe);
#endif
  sums.k0 = add_lobe(sums.k0, flux.x, lobe);
  sums.k1 = add_lobe(sums.k1, flux.y, lobe);
  sums.k2 = add_lobe(sums.k2, flux.z, lobe);
  return sums;
}

#endif

static inline void store_sums(__global float* partials, const uint slot, const Sums sums) {
  __global float* to = partials + slot * (CLPV_CHANNELS * CLPV_N);
#define CLPV_DO(i) to[i] = sums.k0.c##i;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
#if !CLPV_GEOMETRY
#define CLPV_DO(i) to[CLPV_N + i] = sums.k1.c##i, to[2 * CLPV_N + i] = sums.k2.c##i;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
#endif
}

static inline Sums add_stored(Sums sums, __global const float* partials, const uint slot) {
  __global const float* from = partials + slot * (CLPV_CHANNELS * CLPV_N);
#define CLPV_DO(i) sums.k0.c##i += from[i];
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
#if !CLPV_GEOMETRY
#define CLPV_DO(i) sums.k1.c##i += from[CLPV_N + i], sums.k2.c##i += from[2 * CLPV_N + i];
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
#endif
  return sums;
}

// First of the sorted texels [0, before) that is of the cell `key`; `before` is one itself.
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

// Where the first segment starts that does so at or after `at`: where a cell does, or a whole number of segments on.
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

// One work-item a block of `length` sorted texels: sums the segments, of up to `length` texels of a cell, that start
// in it. A cell of one segment is delivered; of a longer cell, `firsts` has where it starts and `partials` the sums:
// in slot 2 block + 1 of its first segment, in slot 2 block of another one. A block starts at most one of either.
__kernel void sum_segments(__global const uint2* sorted, __global const uint* count, const uint length,
                           const uint blocks, CLPV_TEXELS, CLPV_VOLUME_OUT volume,
                           __global float* partials, __global uint* firsts CLPV_AND_TABLE) {
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

// Delivers the cells of several segments: one work-item a block, for the cell whose first segment starts in it.
__kernel void join_segments(__global const uint2* sorted, __global const uint* count, const uint length,
                            const uint blocks, CLPV_VOLUME_OUT volume, __global const float* partials,
                            __global const uint* firsts) {
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
