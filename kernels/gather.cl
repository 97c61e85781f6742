// SPDX-License-Identifier: MIT
// Gather: the irradiance [W/m^2] that the volumes put on every surface the camera sees.
//
//   E(n) = g(n) . M c / s^2,   c the coefficients sampled trilinearly at p + offset s n,
//   g and M by basis and transport (host/basis/gather_form.hpp), E clamped at 0 after the dot product.
// A cascade weighs min(1, distance to its boundary / CLPV_BLEND), the distance in cells at p itself; finer ones come
// first and a coarser one gets what they left. So E is continuous everywhere, and 0 outside all cascades. The boundary is that
// of the cube about the eye that lies in the grid wherever in its cell the eye is: shares glide as the eye does, and do not
// jump when the grid does.
//
// CLPV_PACKED 1: from records of M c (pack.cl, gather_packed.h), whatever the volumes' layout; 0: from images as they are
// (gather_image.h), where M is applied to the weights. Each of the two defines
//   CLPV_GATHERED, Sampled                     a cascade's volume; a point's coefficients
//   Sampled clpv_sample(volume, at)            trilinear at `at`, in cells from the first cell's centre; points beyond
//                                              the outermost centres take their value
//   float3 clpv_weigh(weights, sampled)        weights . coefficients, a channel
//
// `unit`: what a stored 1 stands for [W/sr].
//
// The host writes, beside the literals below and the functions of n,
//   Coefficients clpv_gather_weights(float3 n CLPV_PASS_TABLE), Coefficients clpv_floor_weights(void)
// Where b comes from a look-up table, `gather` has it as its last argument.
#include "coefficients.h"
#include "shared/grid.h"
#include "surface.h"

#ifndef CLPV_FLOORED
#define CLPV_FLOORED 0  // 1: E is at least what clpv_floor_weights() give
#endif

#ifndef CLPV_VISIBLE
#define CLPV_VISIBLE 0  // 1: cells that are hidden from a surface do not light it (see.cl)
#endif

#if CLPV_PACKED
#include "gather_packed.h"
#else
#include "gather_image.h"
#endif

// E s^2 of one volume.
CLPV_INLINE float3 clpv_irradiance(CLPV_GATHERED volume, const float3 at, const Coefficients weights) {
  const Sampled sampled = clpv_sample(volume, at);
  float3 least = 0.0f;
#if CLPV_FLOORED
  least = max(clpv_weigh(clpv_floor_weights(), sampled), 0.0f);
#endif
  return max(clpv_weigh(weights, sampled), least);
}

// Adds what a cascade puts on a surface. `left`: what finer cascades left to this one.
CLPV_INLINE void clpv_add_cascade(float3* sum, float* left, const ClpvGrid grid, const float3 position,
                                  const float3 normal, const Coefficients weights, CLPV_GATHERED volume) {
  const float per_cell = 1.0f / grid.cell;
  const float3 at = (position - clpv_float3(grid.origin)) * per_cell;
  const float3 off = fabs(position - clpv_float3(grid.middle)) * per_cell;
  const float inside = (float)CLPV_GRID_REACH(CLPV_GRID) - fmax(fmax(off.x, off.y), off.z);
  const float share = clamp(inside * CLPV_INVERSE_BLEND, 0.0f, 1.0f);
  if (share == 0.0f) return;
  const float3 point = at + CLPV_GATHER_OFFSET * normal - 0.5f;
  *sum += share * *left * per_cell * per_cell * clpv_irradiance(volume, point, weights);
  *left *= 1.0f - share;
}

__kernel void gather(const ClpvView view, __global const float* depths, __global const SurfaceTexel* normals,
                     __global const ClpvGrid* grids, const uint cascades, const float unit, __global float4* irradiance
                     CLPV_GATHERED_VOLUMES CLPV_AND_TABLE) {
  const uint px = get_global_id(0), py = get_global_id(1);
  if (px >= view.width || py >= view.height) return;
  const uint pixel = py * view.width + px;
  const float depth = depths[pixel];
  float3 sum = 0.0f;
  if (depth > 0.0f) {
    const float3 position = clpv_position(view, (float)px, (float)py, depth);
    const float3 normal = clpv_load_normal(normals, pixel);
    const Coefficients weights = clpv_gather_weights(normal CLPV_PASS_TABLE);
    float left = 1.0f;
#define CLPV_ADD_CASCADE(c, volume) clpv_add_cascade(&sum, &left, grids[c], position, normal, weights, volume)
    CLPV_ADD_CASCADES
  }
  irradiance[pixel] = (float4)(unit * sum.x, unit * sum.y, unit * sum.z, 0.0f);
}
