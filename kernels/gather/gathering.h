// SPDX-License-Identifier: MIT
// Irradiance of W pixels from the volumes of all cascades, one after the other: shared by gather.cl
// and gather_images.cl.
//
// Before it come gather_packed.h or the functions of gather_images.cl, which define
//   Sampled, SamplePoints                         coefficients at a point; W points
//   find_sample_points(at, clear, eye, &points)   W points [cells] from the first centre, clamped
//                                                 to the grid; `clear`, `eye`: gather_packed.h
//   float sample_cells(volume, points, i, &s)     sets s to the coefficients at point i; multiply
//                                                 them by the returned factor
//   float4 weigh(weights, sampled)                weights . coefficients for each channel, and 0
// and defines
//   CLPV_GATHERED                                 type of a cascade's volume
//
// From the host: CLPV_GRID, CLPV_INVERSE_BLEND, CLPV_GATHER_OFFSET; CLPV_FACE_TRANSPORT 1: light of
// steps, 0: swept light; and the literals of basis/basis.h.
#pragma once

#include "basis/basis.h"
#include "gather/cascades.h"
#include "raster/surface_row.h"

// g(n): 4 b(-n), or alpha(-n) for swept light.
CLPV_INLINE Coefficients gather_weights(const float x, const float y, const float z CLPV_AND_G) {
  if (CLPV_FACE_TRANSPORT)
    return scale_coefficients(4.0f, functions_at(-x, -y, -z CLPV_PASS_G));
  return cosine_integrals(-x, -y, -z);
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
  Vec clear;        // way to the eye [m], or 0
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
  find_sample_points(
      find_cascade_points(grid, g->surfaces.position, (realW)(CLPV_GATHER_OFFSET), lift),
      vec_times(g->clear, (realW)(per_cell)), g->clear, &points);
  float shares[W];
  store_lanes(weight, shares);
  for (int i = 0; i < W; ++i) {
    if (shares[i] > 0.0f)
      g->sums[i] += shares[i] * volume_irradiance(volume, &points, i, g->weights[i]);
  }
}

// Finds the weights of W pixels, before any cascade is added.
CLPV_INLINE void begin_gathering(const ClpvView view, Gathering* g CLPV_AND_G) {
  g->clear = towards_eye(view, g->surfaces.position);
  g->remaining = g->surfaces.depth > ZERO ? ONE : ZERO;
  const VecLanes normal = unpack((intW)(-1), g->surfaces.normal);
  for (int i = 0; i < W; ++i) {
    g->weights[i] = gather_weights(normal.x[i], normal.y[i], normal.z[i] CLPV_PASS_G);
    g->sums[i] = 0.0f;
  }
}
