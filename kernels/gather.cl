// Gather: the irradiance [W/m^2] that the volumes put on every surface the camera sees.
//
//   E(n) = g(n) . c / s^2,   c the coefficients sampled trilinearly at p + offset s n,
//   g(n) = 4 b(-n) or alpha(-n) K by transport (host/basis/transport.hpp), E clamped at 0 after the dot product.
// A cascade weighs min(1, distance to its boundary / CLPV_BLEND), the distance in cells at p itself; finer ones come
// first and a coarser one gets what they left. So E is continuous everywhere, and 0 outside all cascades.
//
// From buffers by way of records, whatever their layout (gather_packed.h); images are sampled as they are
// (gather_image.h). Each of the two defines
//   CLPV_GATHERED, Sampled                     a cascade's volume; a point's coefficients
//   Sampled clpv_sample(volume, at)            trilinear at `at`, in cells from the first cell's centre; points beyond
//                                              the outermost centres take their value
//   float3 clpv_weigh(weights, sampled)        weights . coefficients, a channel
//
// The host writes, beside the literals below and the basis's functions,
//   Coefficients clpv_gather_weights(float3 n CLPV_PASS_TABLE), Coefficients clpv_floor_weights(void)
// Where b comes from a look-up table, `gather` has it as its last argument.
#include "volume/light.h"
#include "shared/grid.h"
#include "surface.h"

#ifndef CLPV_LATE
#define CLPV_LATE 0  // 1: coarser cascades add their late light; the packed volumes are then full, late, full, ...
#endif
#ifndef CLPV_FLOORED
#define CLPV_FLOORED 0  // 1: E is at least clpv_floor_weights() . c / s^2
#endif

#if CLPV_LAYOUT == CLPV_IMAGE
#include "gather_image.h"
#else
#include "gather_packed.h"

// `first`: index of the volume's first cell among the packed ones.
__kernel void pack(CLPV_VOLUME_IN volume, __global float8* packed, const uint first) {
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  if (x >= CLPV_GRID) return;
  const Coefficients r = light_load(volume, 0, x, y, z);
  const Coefficients g = light_load(volume, 1, x, y, z);
  const Coefficients b = light_load(volume, 2, x, y, z);
  __global float8* cell = packed + (size_t)(first + (z * CLPV_GRID + y) * CLPV_GRID + x) * CLPV_PAIRS;
#define CLPV_DO(j, even, odd) \
  cell[j] = (float8)(even(r), even(g), even(b), 0.0f, odd(r), odd(g), odd(b), 0.0f);
  CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
}
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
                                  const float3 normal, const Coefficients weights, CLPV_GATHERED full,
                                  CLPV_GATHERED late) {
  const float per_cell = 1.0f / grid.cell;
  const float3 at = (position - clpv_float3(grid.origin)) * per_cell;
  const float3 inside = min(at, (float)CLPV_GRID - at);
  const float share = clamp(fmin(fmin(inside.x, inside.y), inside.z) * CLPV_INVERSE_BLEND, 0.0f, 1.0f);
  if (share == 0.0f) return;
  const float3 point = at + CLPV_GATHER_OFFSET * normal - 0.5f;
  const float scale = share * per_cell * per_cell;
  if (*left > 0.0f) *sum += scale * *left * clpv_irradiance(full, point, weights);
#if CLPV_LATE
  if (*left < 1.0f) *sum += scale * (1.0f - *left) * clpv_irradiance(late, point, weights);
#endif
  *left *= 1.0f - share;
}

__kernel void gather(const ClpvView view, __global const float* depths, __global const SurfaceTexel* normals,
                     __global const ClpvGrid* grids, const uint cascades, __global float4* irradiance
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
#define CLPV_ADD_CASCADE(c, full, late) \
  clpv_add_cascade(&sum, &left, grids[c], position, normal, weights, full, late)
    CLPV_ADD_CASCADES
  }
  irradiance[pixel] = (float4)(sum.x, sum.y, sum.z, 0.0f);
}
