// Injection: what a view sees becomes light or blocking in the cells of a volume (MATH section 4).
//
// CLPV_GEOMETRY 0, light: a texel is a virtual point light of flux P [W] at p + n s/2, half a cell off its surface
// so that the surface does not light itself; its cell gains (P/pi) c(n), c(n) the clamped cosine round n.
// CLPV_GEOMETRY 1, blocking: a texel is a surfel of area A at p; the nearest corner of the cells gains
// (A/s^2) (c(n) + c(-n)), or (A/s^2) c(n) with CLPV_TWO_SIDED 0. Of all surfaces injected, a corner keeps the one
// with the larger mean, since they see the same walls.
//
// c(n) = A^-1 alpha(n) is linear in alpha: a cell sums its texels' weighted alpha, and the matrix comes once a cell.
// Three steps: find_cells gives every texel its cell; sort_by_cell.cl sorts them; sum_segments and join_segments add
// up each cell's texels in their order in the surface. A cell's sum depends on its own texels alone, to the bit:
// it is made of segments counted from the cell's first texel.
//
// From the host: CLPV_GRID, CLPV_STRIP, CLPV_GEOMETRY, CLPV_TWO_SIDED, CLPV_TRILINEAR, CLPV_UNIT_FLUX,
// CLPV_SURFACE_PAPER; as text what host/pipeline/inject_source.hpp lists.
#include "coefficients.h"
#include "inject_cells.h"
#include "shared/grid.h"
#include "surface.h"

// A cosine floored here bounds the surfel behind a pixel seen edge-on.
#define CLPV_LEAST_COSINE 0.1f
#define CLPV_NO_SEGMENT 0xffffffffu

// Conditions as int, joined by &: no branches. Of scalars: Oclgrind 21.10 trips over comparisons of float3.
static inline int all_finite(const float x, const float y, const float z) {
  return (fabs(x) <= MAXFLOAT) & (fabs(y) <= MAXFLOAT) & (fabs(z) <= MAXFLOAT);
}
static inline int not_zero(const float x, const float y, const float z) {
  return (x != 0.0f) | (y != 0.0f) | (z != 0.0f);
}

static inline float blocked_share(const ClpvView view, const ClpvGrid grid, const float px, const float py,
                                  const float depth, const float3 normal) {
  const float3 ray = clpv_ray(view, px, py);
  const float cosine = fabs(normal.x * ray.x + normal.y * ray.y + normal.z * ray.z);
  return clpv_footprint(view, px, py, depth) / (fmax(cosine, CLPV_LEAST_COSINE) * grid.cell * grid.cell);
}

// keys[texel]: its cell, or CLPV_NO_CELL for what is empty, dark, outside the grid or not finite.
// details, geometry: the share of a cell's cross-section that the texel's surfel covers, seen along its normal.
// Trilinear light: where it is between the 8 cells' centres, in [0, 1): all texels' x, all y, all z.
//
// One work-item a strip of CLPV_STRIP texels of a row: CPU devices vectorise the loop (which they do not across
// work-items, where they first pack y and z), if there is no float3 in memory and no floor() in it.
__kernel void find_cells(const ClpvView view, const ClpvGrid grid, __global const float* restrict depths,
                         __global const SurfaceTexel* restrict normals, __global const SurfaceTexel* restrict colours,
                         const float colour_scale, __global uint* restrict keys, __global float* restrict details) {
  const uint first = get_global_id(0) * CLPV_STRIP, py = get_global_id(1);
  if (first >= view.width || py >= view.height) return;
  const uint last = min(first + CLPV_STRIP, view.width);
  const float per_metre = 1.0f / grid.cell;
  for (uint px = first; px < last; ++px) {
    const uint texel = py * view.width + px;
    const float depth = depths[texel];
    const float3 normal = clpv_load_normal(normals, texel);
    const float3 position = clpv_position(view, (float)px, (float)py, depth);
    float x = (position.x - grid.origin[0]) * per_metre, y = (position.y - grid.origin[1]) * per_metre,
          z = (position.z - grid.origin[2]) * per_metre;
    int counts = (depth > 0.0f) & all_finite(normal.x, normal.y, normal.z) & not_zero(normal.x, normal.y, normal.z);
#if CLPV_GEOMETRY
    details[texel] = blocked_share(view, grid, (float)px, (float)py, depth, normal);
#else
    x += 0.5f * normal.x, y += 0.5f * normal.y, z += 0.5f * normal.z;
    const float3 flux = clpv_load_colour(colours, texel, colour_scale);
    counts = counts & all_finite(flux.x, flux.y, flux.z) & not_zero(flux.x, flux.y, flux.z);
#endif
    x += CLPV_CELL_SHIFT, y += CLPV_CELL_SHIFT, z += CLPV_CELL_SHIFT;
    counts = counts & in_grid(x, y, z);  // no point that is not finite is
    const uint cx = counts ? (uint)x : 0, cy = counts ? (uint)y : 0, cz = counts ? (uint)z : 0;
    keys[texel] = counts ? cell_key(cx, cy, cz) : CLPV_NO_CELL;
#if CLPV_TRILINEAR
    const uint texels = view.width * view.height;
    details[texel] = x - (float)cx;
    details[texels + texel] = y - (float)cy;
    details[2 * texels + texel] = z - (float)cz;
#endif
  }
}

// Everything a texel is weighted by.
#define CLPV_TEXELS                                                                                     \
  __global const SurfaceTexel *normals, __global const SurfaceTexel *colours, const float colour_scale, \
      __global const float *details, const uint texels
#define CLPV_PASS_TEXELS normals, colours, colour_scale, details, texels

static inline Sums no_sums(void) {
  Sums sums;
#define CLPV_DO(i) sums.k0.c##i = (Lanes)(0.0f);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
#if !CLPV_GEOMETRY
  sums.k1 = sums.k0;
  sums.k2 = sums.k0;
#endif
  return sums;
}

static inline Sum add_lobe(Sum sum, const Lanes weight, const Coefficients lobe) {
#define CLPV_DO(i) sum.c##i = fma(weight, (Lanes)(lobe.c##i), sum.c##i);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return sum;
}

#if CLPV_GEOMETRY

static inline Sums add_texel(Sums sums, const uint texel, CLPV_TEXELS) {
  const float3 n = clpv_load_normal(normals, texel);
  sums.k0 = add_lobe(sums.k0, details[texel], clpv_lobe_integrals(n.x, n.y, n.z));
#if CLPV_TWO_SIDED
  sums.k0 = add_lobe(sums.k0, details[texel], clpv_lobe_integrals(-n.x, -n.y, -n.z));
#endif
  return sums;
}

#else

static inline Lanes cell_weights(__global const float* details, const uint texels, const uint texel) {
#if CLPV_TRILINEAR
  const float x = details[texel], y = details[texels + texel], z = details[2 * texels + texel];
  const float4 plane = (float4)((1.0f - x) * (1.0f - y), x * (1.0f - y), (1.0f - x) * y, x * y);
  return (float8)(plane * (1.0f - z), plane * z);
#else
  return 1.0f;
#endif
}

static inline Sums add_texel(Sums sums, const uint texel, CLPV_TEXELS) {
  const float3 n = clpv_load_normal(normals, texel);
  const Coefficients lobe = clpv_lobe_integrals(n.x, n.y, n.z);
  float3 flux = clpv_load_colour(colours, texel, colour_scale);
#if CLPV_UNIT_FLUX
  flux *= M_PI_F / clpv_flux(lobe);
#endif
  const Lanes weights = cell_weights(details, texels, texel);
  sums.k0 = add_lobe(sums.k0, weights * flux.x, lobe);
  sums.k1 = add_lobe(sums.k1, weights * flux.y, lobe);
  sums.k2 = add_lobe(sums.k2, weights * flux.z, lobe);
  return sums;
}

#endif

static inline void store_sums(__global Lanes* partials, const uint slot, const Sums sums) {
  __global Lanes* to = partials + slot * (CLPV_CHANNELS * CLPV_N);
#define CLPV_DO(i) to[i] = sums.k0.c##i;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
#if !CLPV_GEOMETRY
#define CLPV_DO(i) to[CLPV_N + i] = sums.k1.c##i, to[2 * CLPV_N + i] = sums.k2.c##i;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
#endif
}

static inline Sums add_stored(Sums sums, __global const Lanes* partials, const uint slot) {
  __global const Lanes* from = partials + slot * (CLPV_CHANNELS * CLPV_N);
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
                           const uint blocks, const uint phase, CLPV_TEXELS, CLPV_VOLUME_OUT volume,
                           __global Lanes* partials, __global uint* firsts) {
  const uint block = get_global_id(0);
  if (block >= blocks) return;
  firsts[block] = CLPV_NO_SEGMENT;
  const uint total = count[0];
  const uint stop = min((block + 1) * length, total);
  if (block * length >= stop) return;
  if (phase_of(sorted[block * length].x) > phase || phase_of(sorted[stop - 1].x) < phase) return;
  bool starts_cell;
  uint at = first_segment(sorted, total, length, block, &starts_cell);
  while (at < stop) {
    const uint key = sorted[at].x;
    const uint first = at, end = min(at + length, total);
    const bool wanted = phase_of(key) == phase;
    Sums sums = no_sums();
    for (; at < end && sorted[at].x == key; ++at) {
      if (wanted) sums = add_texel(sums, sorted[at].y, CLPV_PASS_TEXELS);
    }
    const bool ends_cell = at == total || sorted[at].x != key;
    if (wanted && starts_cell && ends_cell) {
      deliver(volume, key, sums);
    } else if (wanted) {
      store_sums(partials, 2 * block + (starts_cell ? 1 : 0), sums);
      if (starts_cell) firsts[block] = first;
    }
    starts_cell = true;
  }
}

// Delivers the cells of several segments: one work-item a block, for the cell whose first segment starts in it.
__kernel void join_segments(__global const uint2* sorted, __global const uint* count, const uint length,
                            const uint blocks, CLPV_VOLUME_OUT volume, __global const Lanes* partials,
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
