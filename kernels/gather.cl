// SPDX-License-Identifier: MIT
// Gather: the irradiance [W/m^2] that the volumes put on every surface the camera sees.
//
//   E(n) = g(n) . c / s^2,   c the coefficients sampled trilinearly at p + offset s n,
//   g by basis and transport (has_faces, host/basis/transport.hpp), E clamped at 0 after the dot product.
// A cascade weighs min(1, distance to its boundary / CLPV_BLEND), the distance in cells at p itself; finer ones come
// first and a coarser one gets what they left. So E is continuous everywhere, and 0 outside all cascades. The boundary is that
// of the cube about the eye that lies in the grid wherever in its cell the eye is: shares glide as the eye does, and do not
// jump when the grid does.
//
// A work-item is eight pixels of a row. Where they lie in a cascade is found side by side; each then has its own cells to
// read, and is gathered by itself.
//
// CLPV_PACKED 1: from records of c (pack.cl, gather_packed.h), whatever the volumes' layout; 0: from images as they are
// (gather_image.h). Each of the two defines
//   CLPV_GATHERED, Sampled                     a cascade's volume; a point's coefficients
//   Places, void clpv_places(at, &places)      eight points, in cells from the first cell's centre; points beyond the
//                                              outermost centres take their value
//   float clpv_sample(volume, places, i, &s)   trilinear at the i-th of them, times the number that is returned
//   float4 clpv_weigh(weights, sampled)        weights . coefficients, a channel; 0
//
// `unit`: what a stored 1 stands for [W/sr].
//
// The host writes, beside the literals below,
//   Coefficients clpv_gather_weights(float3 n CLPV_AND_TABLE)   g(n)
// Where b comes from a look-up table, `gather` has it as its last argument.
#include "coefficients.h"
#include "shared/grid.h"
#include "surface_row.h"

#ifndef CLPV_VISIBLE
#define CLPV_VISIBLE 0  // 1: cells that are hidden from a surface do not light it (visibility.cl)
#endif

// Between 0 and `most`; what is no number is 0.
CLPV_INLINE float8 clpv_within(const float8 v, const float most) {
  const float8 none = (float8)(0.0f), all = (float8)(most);
  return v > none ? (v < all ? v : all) : none;
}

#if CLPV_PACKED
#include "gather_packed.h"
#else
#include "gather_image.h"
#endif

// E s^2 of one volume at the i-th of `places`.
CLPV_INLINE float4 clpv_irradiance(CLPV_GATHERED volume, const Places* places, const int i,
                                   const Coefficients weights) {
  Sampled sampled;
  const float scale = clpv_sample(volume, places, i, &sampled);
  return scale * max(clpv_weigh(weights, sampled), 0.0f);
}

// What eight pixels have been given so far, and how they take it.
typedef struct {
  Surfaces seen;
  float8 left;  // the share that finer cascades left
  Coefficients weights[CLPV_ABREAST];
  float4 sums[CLPV_ABREAST];
} Gathering;

// Adds what a cascade puts on the surfaces.
CLPV_INLINE void clpv_add_cascade(Gathering* g, __global const ClpvGrid* of, CLPV_GATHERED volume) {
  const ClpvGrid grid = *of;
  const float per_cell = 1.0f / grid.cell;
  const Vec off = vec_minus(g->seen.position, vec_of(grid.middle));
  const float8 x = fabs(off.x), y = fabs(off.y), z = fabs(off.z), xy = x > y ? x : y;
  const float8 farthest = xy > z ? xy : z;
  const float8 inside = (float)CLPV_GRID_REACH(CLPV_GRID) - farthest * per_cell;
  const float8 share = clpv_within(inside * CLPV_INVERSE_BLEND, 1.0f);
  const float8 given = share * g->left * (per_cell * per_cell);
  g->left *= 1.0f - share;
  if (none(given > (float8)(0.0f))) return;
  const Vec at = vec_times(vec_minus(g->seen.position, vec_of(grid.origin)), (float8)(per_cell));
  const Vec lifted = vec_add_scaled(at, (float8)(CLPV_GATHER_OFFSET), g->seen.normal);
  Places places;
  clpv_places(vec(lifted.x - 0.5f, lifted.y - 0.5f, lifted.z - 0.5f), &places);
  float shares[CLPV_ABREAST];
  vstore8(given, 0, shares);
  for (int i = 0; i < CLPV_ABREAST; ++i) {
    if (shares[i] > 0.0f) g->sums[i] += shares[i] * clpv_irradiance(volume, &places, i, g->weights[i]);
  }
}

__kernel void gather(const ClpvView view, __global const float* depths, __global const float4* normals,
                     __global const ClpvGrid* grids, const uint cascades, const float unit, __global float4* irradiance
                     CLPV_GATHERED_VOLUMES CLPV_AND_TABLE) {
  const Eight p = this_row(view);
  if (p.count == 0) return;
  Gathering g;
  surfaces(view, p, depths, normals, &g.seen);
  g.left = g.seen.depth > (float8)(0.0f) ? (float8)(1.0f) : (float8)(0.0f);
  const Unpacked normal = unpack((int8)(-1), g.seen.normal);
  for (int i = 0; i < CLPV_ABREAST; ++i) {
    g.weights[i] = clpv_gather_weights((float3)(normal.x[i], normal.y[i], normal.z[i]) CLPV_PASS_TABLE);
    g.sums[i] = 0.0f;
  }
#define CLPV_ADD_CASCADE(c, volume) clpv_add_cascade(&g, grids + c, volume)
  CLPV_ADD_CASCADES
  for (uint i = 0; i < p.count; ++i) irradiance[g.seen.first + i] = unit * g.sums[i];
}
