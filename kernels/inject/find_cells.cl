// SPDX-License-Identifier: MIT
// Finds the cell of each texel of `injections`: the first step of injection (light.cl, surfels.cl).
//
//   light:     cell of p + h n s         h = (|n_x| + |n_y| + |n_z|) / 2: the cell's centre is in
//                                        front of the surface, so that light does not start
//                                        behind it; 1/2 without CLPV_IN_FRONT. With CLPV_VISIBLE
//                                        the nearest cell that all eight sample points about it
//                                        see, so that it does not start behind another surface
//   blocking:  corner nearest to p       B = A / (max(|n.w|, 0.1) s^2): blocked share of a surfel;
//                                        its footprint A along w is that of stride x stride texels
//
// docs/method.md, 'Injection' and 'Blockers'.
//
// In:   injections   surfaces and their grids (shared/view_injection.h)
//       places   depths [m]; with CLPV_POINTS positions [m] instead (emit.cl)
//       normals; colours: flux [W], see surface.h for colour_scale
//       stride   blocking: subsampling; a texel represents stride x stride texels
//                (shared/subsampling.h)
//       occluded CLPV_VISIBLE: occlusion bits of all cascades (voxels/visibility.cl)
// Out:  keys    key of the cell of each texel of each surface (cell_keys.h); CLPV_NO_CELL for
//               texels that are empty, dark, outside the grid, not finite or, but for points,
//               see no cell
//       shares  blocking: B of each texel
// A work-item processes a strip of CLPV_STRIP texels of a row. Compilers vectorise this loop on
// CPUs, if it accesses memory by scalars and calls no floor(). From the host: CLPV_GEOMETRY (0
// light, 1 blocking), CLPV_IN_FRONT, CLPV_VISIBLE, CLPV_POINTS, CLPV_STRIP, CLPV_SURFACE_PAPER.
#include "inject/cell_keys.h"
#include "shared/grid.h"
#include "shared/subsampling.h"
#include "raster/surface.h"
#include "shared/view_injection.h"
#include "volume/seen_cells.h"

#define CLPV_MIN_COSINE 0.1f  // bounds the area of a surfel that is seen edge-on

// Conditions are ints joined by &, without branches, and of scalars: Oclgrind 21.10 fails on
// comparisons of float3.
static inline int in_grid(const float n, const float x, const float y, const float z) {
  return (x >= 0.0f) & (y >= 0.0f) & (z >= 0.0f) & (x < n) & (y < n) & (z < n);
}
static inline int all_finite(const float x, const float y, const float z) {
  return (fabs(x) <= MAXFLOAT) & (fabs(y) <= MAXFLOAT) & (fabs(z) <= MAXFLOAT);
}
static inline int not_zero(const float x, const float y, const float z) {
  return (x != 0.0f) | (y != 0.0f) | (z != 0.0f);
}

static inline float blocked_share(const ClpvView view, const ClpvGrid grid, const float px,
                                  const float py, const float depth, const float3 normal,
                                  const uint stride) {
  const float3 ray = pixel_ray(view, px, py);
  const float cosine = fabs(normal.x * ray.x + normal.y * ray.y + normal.z * ray.z);
  return (stride * stride) * pixel_footprint(view, px, py, depth) /
         (fmax(cosine, CLPV_MIN_COSINE) * grid.cell * grid.cell);
}

#if CLPV_VISIBLE
// Key of the nearest cell to `at` that all eight sample points about `at` see. `at`: [cells] from
// the first centre, in a grid of n^3 cells.
static inline uint nearest_in_sight(__global const uchar* occluded, const int n, const float3 at) {
  const int highest = max(n - 2, 0), end = 4 * highest + 3;
  const float3 p = clamp(at, 0.0f, (float)(n - 1));
  const int x = min((int)p.x, highest), y = min((int)p.y, highest), z = min((int)p.z, highest);
  const int a = (int)(4.0f * p.x + 0.5f) - 1, b = (int)(4.0f * p.y + 0.5f) - 1,
            c = (int)(4.0f * p.z + 0.5f) - 1;
  uint seen = 255u;
  for (int i = 0; i < 8; ++i) {
    const int u = clamp(a + (i & 1), 0, end), v = clamp(b + (i >> 1 & 1), 0, end),
              w = clamp(c + (i >> 2), 0, end);
    seen &= cells_from(seen_cells(occluded, n, u, v, w), (u >> 2) - x, (v >> 2) - y, (w >> 2) - z);
  }
  float least = MAXFLOAT;
  uint key = CLPV_NO_CELL;
  for (int i = 0; i < 8; ++i) {
    const int cx = x + (i & 1), cy = y + (i >> 1 & 1), cz = z + (i >> 2);
    const float dx = at.x - (float)cx, dy = at.y - (float)cy, dz = at.z - (float)cz,
                square = dx * dx + dy * dy + dz * dz;
    const bool nearest = (seen >> i & 1u) != 0 && square <= least;  // ties: as floor()
    least = nearest ? square : least;
    key = nearest ? cell_key((uint)n, (uint)cx, (uint)cy, (uint)cz) : key;
  }
  return key;
}
#endif

__kernel void find_cells(__global const ClpvInjection* restrict injections,
                         __global const float* restrict places,
                         __global const SurfaceTexel* restrict normals,
                         __global const SurfaceTexel* restrict colours,
                         __global uint* restrict keys
#if CLPV_GEOMETRY
                         ,
                         __global float* restrict shares, const uint stride
#endif
#if CLPV_VISIBLE
                         ,
                         __global const uchar* restrict occluded
#endif
) {
#if !CLPV_GEOMETRY
  const uint stride = 1;
#endif
  const uint surface = get_global_id(2), first_texel = injections[surface].first;
  const ClpvView view = injections[surface].view;
  const ClpvGrid grid = injections[surface].grid;
  const float colour_scale = injections[surface].colour_scale;
  const uint width = sampled_texels(view.width, stride),
             height = sampled_texels(view.height, stride);
  const uint first = get_global_id(0) * CLPV_STRIP, row = get_global_id(1);
  if (first >= width || row >= height) return;
  const uint last = min(first + CLPV_STRIP, width);
  const uint py = sampled_texel(row, stride);
  const uint n = grid.n + CLPV_GEOMETRY, first_key = surface * n * n * n;
  const float per_metre = 1.0f / grid.cell;
  for (uint column = first; column < last; ++column) {
    const uint px = sampled_texel(column, stride), texel = first_texel + py * view.width + px,
               i = (surface * height + row) * width + column;
    const float3 normal = load_normal(normals, texel);
    const float depth = CLPV_POINTS ? 1.0f : places[texel];
    const float3 position =
        CLPV_POINTS ? (float3)(places[4 * texel], places[4 * texel + 1], places[4 * texel + 2])
                    : surface_position(view, (float)px, (float)py, depth);
    float x = (position.x - grid.origin[0]) * per_metre,
          y = (position.y - grid.origin[1]) * per_metre,
          z = (position.z - grid.origin[2]) * per_metre;
    int valid = (depth > 0.0f) & all_finite(normal.x, normal.y, normal.z) &
                not_zero(normal.x, normal.y, normal.z);
#if CLPV_GEOMETRY
    shares[i] = blocked_share(view, grid, (float)px, (float)py, depth, normal, stride);
#else
    const float sides = fabs(normal.x) + fabs(normal.y) + fabs(normal.z),
                h = CLPV_IN_FRONT ? 0.5f * sides : 0.5f;
    x += h * normal.x, y += h * normal.y, z += h * normal.z;
    const float3 flux = load_colour(colours, texel, colour_scale);
    valid = valid & all_finite(flux.x, flux.y, flux.z) & not_zero(flux.x, flux.y, flux.z);
#endif
    const float shift = 0.5f * CLPV_GEOMETRY;  // corners lie half a cell off the centres
    x += shift, y += shift, z += shift;
    valid = valid & in_grid((float)n, x, y, z);  // false for points that are not finite
    const uint cx = valid ? (uint)x : 0, cy = valid ? (uint)y : 0, cz = valid ? (uint)z : 0;
    uint key = valid ? cell_key(n, cx, cy, cz) : CLPV_NO_CELL;
#if CLPV_VISIBLE
    if (valid) {
      __global const uchar* of = occluded + 64 * (size_t)injections[surface].cascade * n * n * n;
      const uint seen = nearest_in_sight(of, (int)n, (float3)(x, y, z) - 0.5f);
      key = CLPV_POINTS && seen == CLPV_NO_CELL ? key : seen;
    }
#endif
    keys[i] = key == CLPV_NO_CELL ? key : first_key + key;
  }
}
