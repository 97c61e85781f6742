// SPDX-License-Identifier: MIT
// Injection, first step: which cell each texel of a surface belongs to (kernels/inject.cl).
//
// CLPV_GEOMETRY 0, light: a texel's virtual point light is at p + n s/2, half a cell off its surface, so that the surface
// does not light itself. CLPV_GEOMETRY 1, blocking: its surfel is at p.
//
// CLPV_POINTS 1: texels are points that no view sees (emit.cl), at `positions`.
//
// From the host: CLPV_GEOMETRY, CLPV_POINTS, CLPV_STRIP, CLPV_SURFACE_PAPER. Nothing here depends on the basis. Blocking is told
// its stride (shared/thinned.h); light takes every texel, as literals tell the compiler, which then loads them side by side.
#include "cell_keys.h"
#include "shared/grid.h"
#include "shared/thinned.h"
#include "surface.h"

// A cosine floored here bounds the surfel behind a pixel seen edge-on.
#define CLPV_LEAST_COSINE 0.1f

// Conditions as int, joined by &: no branches. Of scalars: Oclgrind 21.10 trips over comparisons of float3.
static inline int in_grid(const float n, const float x, const float y, const float z) {
  return (x >= 0.0f) & (y >= 0.0f) & (z >= 0.0f) & (x < n) & (y < n) & (z < n);
}
static inline int all_finite(const float x, const float y, const float z) {
  return (fabs(x) <= MAXFLOAT) & (fabs(y) <= MAXFLOAT) & (fabs(z) <= MAXFLOAT);
}
static inline int not_zero(const float x, const float y, const float z) {
  return (x != 0.0f) | (y != 0.0f) | (z != 0.0f);
}

static inline float blocked_share(const ClpvView view, const ClpvGrid grid, const float px, const float py,
                                  const float depth, const float3 normal, const uint stride) {
  const float3 ray = clpv_ray(view, px, py);
  const float cosine = fabs(normal.x * ray.x + normal.y * ray.y + normal.z * ray.z);
  return (stride * stride) * clpv_footprint(view, px, py, depth) /
         (fmax(cosine, CLPV_LEAST_COSINE) * grid.cell * grid.cell);
}

// keys[i] of taken texel i: its cell, or CLPV_NO_CELL for what is empty, dark, outside the grid or not finite.
// shares[i], blocking: the share of a cell's cross-section that the surfel covers, seen along its normal: of all the texels
// that one taken stands for.
//
// One work-item a strip of CLPV_STRIP taken texels of a row: CPU devices vectorise the loop (which they do not across
// work-items, where they first pack y and z), if there is no float3 in memory and no floor() in it.
__kernel void find_cells(const ClpvView view, const ClpvGrid grid,
#if CLPV_POINTS
                         __global const float* restrict positions,
#else
                         __global const float* restrict depths,
#endif
                         __global const SurfaceTexel* restrict normals, __global const SurfaceTexel* restrict colours,
                         const float colour_scale, __global uint* restrict keys
#if CLPV_GEOMETRY
                         , __global float* restrict shares, const uint stride
#endif
) {
#if !CLPV_GEOMETRY
  const uint stride = 1;
#endif
  const uint width = CLPV_TAKEN(view.width, stride), height = CLPV_TAKEN(view.height, stride);
  const uint first = get_global_id(0) * CLPV_STRIP, row = get_global_id(1);
  if (first >= width || row >= height) return;
  const uint last = min(first + CLPV_STRIP, width);
  const uint py = CLPV_TAKEN_TEXEL(row, stride);
  const uint n = CLPV_KEYS(grid.n);
  const float per_metre = 1.0f / grid.cell;
  for (uint column = first; column < last; ++column) {
    const uint px = CLPV_TAKEN_TEXEL(column, stride), texel = py * view.width + px, i = row * width + column;
    const float3 normal = clpv_load_normal(normals, texel);
#if CLPV_POINTS
    const float depth = 1.0f;
    const float3 position = (float3)(positions[4 * texel], positions[4 * texel + 1], positions[4 * texel + 2]);
#else
    const float depth = depths[texel];
    const float3 position = clpv_position(view, (float)px, (float)py, depth);
#endif
    float x = (position.x - grid.origin[0]) * per_metre, y = (position.y - grid.origin[1]) * per_metre,
          z = (position.z - grid.origin[2]) * per_metre;
    int counts = (depth > 0.0f) & all_finite(normal.x, normal.y, normal.z) & not_zero(normal.x, normal.y, normal.z);
#if CLPV_GEOMETRY
    shares[i] = blocked_share(view, grid, (float)px, (float)py, depth, normal, stride);
#else
    x += 0.5f * normal.x, y += 0.5f * normal.y, z += 0.5f * normal.z;
    const float3 flux = clpv_load_colour(colours, texel, colour_scale);
    counts = counts & all_finite(flux.x, flux.y, flux.z) & not_zero(flux.x, flux.y, flux.z);
#endif
    x += CLPV_CELL_SHIFT, y += CLPV_CELL_SHIFT, z += CLPV_CELL_SHIFT;
    counts = counts & in_grid((float)n, x, y, z);  // no point that is not finite is
    const uint cx = counts ? (uint)x : 0, cy = counts ? (uint)y : 0, cz = counts ? (uint)z : 0;
    keys[i] = counts ? cell_key(n, cx, cy, cz) : CLPV_NO_CELL;
  }
}
