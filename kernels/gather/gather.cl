// SPDX-License-Identifier: MIT
// Gathers the irradiance of every surface that the camera sees from the accumulated volumes of all
// cascades.
//
//   E = 4 I(-n) / s^2           steps
//   E = alpha(-n) . c / s^2     sweep
//
// not below 0, with the coefficients c interpolated trilinearly at p + offset s n_g, n_g the normal
// of the triangle (shared/normal.h). docs/method.md,
// 'Gathering'; cascades.h has the weights of cascades.
//
// In:   places, normals   the camera's surface (surface_row.h): depths [m], or with CLPV_POINTS
//                         positions [m]
//       grids       ClpvGrid of each of `cascades` cascades, finest first
//       unit        [W/sr] of a stored 1
//       CLPV_GATHERED_VOLUMES   accumulated volumes: packed records and occlusion bits (CLPV_PACKED
//                               1), or images
// Out:  irradiance  E [W/m^2] per pixel
// A work-item processes W pixels of a row: coordinates in lanes, then pixel by pixel, since each
// reads its own cells.
//
// gather_packed.h and gather_image.h define
//   CLPV_GATHERED, Sampled                        type of a cascade's volume; coefficients at a
//                                                 point
//   SamplePoints, find_sample_points(at, &points) W points [cells] from the first centre, clamped
//   to the grid
//   float sample_cells(volume, points, i, &s)      trilinear at point i, to be multiplied by the
//                                                  result
//   float4 weigh(weights, sampled)           weights . coefficients for each channel, and 0
// From the host: CLPV_GRID, CLPV_INVERSE_BLEND, CLPV_GATHER_OFFSET, CLPV_FACE_TRANSPORT (0: swept
// light), and CLPV_FROM_TABLE 1: functions come from a look-up table, the last argument.
#include "gather/cascades.h"
#include "raster/surface_row.h"

// g(n): 4 b(-n), or alpha(-n) for swept light.
CLPV_INLINE Coefficients gather_weights(const float x, const float y,
                                        const float z CLPV_AND_TABLE) {
#if !CLPV_FACE_TRANSPORT
  return cosine_integrals(-x, -y, -z);
#elif CLPV_FROM_TABLE
  return scale_coefficients(4.0f, table_basis(-x, -y, -z CLPV_PASS_TABLE));
#else
  return scale_coefficients(4.0f, basis_functions(-x, -y, -z));
#endif
}

// E s^2 of one volume at point i.
CLPV_INLINE float4 volume_irradiance(CLPV_GATHERED volume, const SamplePoints* points, const int i,
                                     const Coefficients weights) {
  Sampled sampled;
  const float scale = sample_cells(volume, points, i, &sampled);
  return scale * max(weigh(weights, sampled), 0.0f);
}

// W pixels: surfaces, and the irradiance summed so far.
typedef struct {
  Surfaces surfaces;
  realW remaining;  // weight that finer cascades leave
  Coefficients weights[W];
  float4 sums[W];
} Gathering;

// Adds the irradiance from a cascade.
CLPV_INLINE void add_cascade(Gathering* g, __global const ClpvGrid* of, CLPV_GATHERED volume) {
  const ClpvGrid grid = *of;
  const float per_cell = 1.0f / grid.cell;
  const realW share = cascade_share(grid, g->surfaces.position);
  const realW weight = share * g->remaining * (per_cell * per_cell);
  g->remaining *= 1.0f - share;
  if (no_lane(weight > ZERO)) return;
  SamplePoints points;
  const Vec lift = lift_normal(g->surfaces.geometric, g->surfaces.normal);
  find_cascade_points(grid, g->surfaces.position, (realW)(CLPV_GATHER_OFFSET), lift, &points);
  float shares[W];
  store_lanes(weight, shares);
  for (int i = 0; i < W; ++i) {
    if (shares[i] > 0.0f)
      g->sums[i] += shares[i] * volume_irradiance(volume, &points, i, g->weights[i]);
  }
}

__kernel void gather(const ClpvView view, __global const Place* places,
                     __global const float4* normals, __global const ClpvGrid* grids,
                     const uint cascades, const float unit,
                     __global float4* irradiance CLPV_GATHERED_VOLUMES CLPV_AND_TABLE) {
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  Gathering g;
  CLPV_LOAD_SURFACES(view, p, places, normals, &g.surfaces);
  g.remaining = g.surfaces.depth > ZERO ? ONE : ZERO;
  const VecLanes normal = unpack((intW)(-1), g.surfaces.normal);
  for (int i = 0; i < W; ++i) {
    g.weights[i] = gather_weights(normal.x[i], normal.y[i], normal.z[i] CLPV_PASS_TABLE);
    g.sums[i] = 0.0f;
  }
  // The host's CLPV_ADD_CASCADES calls this for each cascade, the finest first.
#define CLPV_ADD_CASCADE(c, volume) add_cascade(&g, grids + c, volume)
  CLPV_ADD_CASCADES
  for (uint i = 0; i < p.count; ++i) irradiance[g.surfaces.first + i] = unit * g.sums[i];
}
