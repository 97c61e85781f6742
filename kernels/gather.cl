// Gather: the irradiance [W/m^2] that the volumes put on every surface the camera sees.
//
//   E(n) = g(n) . c / s^2,   c the coefficients sampled trilinearly at p + offset s n,
//   g(n) = 4 b(-n) or alpha(-n) K by transport (host/basis/transport.hpp), E clamped at 0 after the dot product.
// A cascade weighs min(1, distance to its boundary / CLPV_BLEND), the distance in cells at p itself; finer ones come
// first and a coarser one gets what they left. So E is continuous everywhere, and 0 outside all cascades.
//
// Two kernels. `pack` brings a cascade's volume, whatever its layout, to one record a cell: CLPV_PAIRS float8, each
// two coefficients as (r g b 0)(r g b 0). `gather` then reads the eight cells round a point as whole vectors, where
// planes would take 24 N scalar reads.
//
// The host writes, beside the literals below and the basis's functions,
//   CLPV_EACH_PAIR(DO)    writes DO(j, even, odd) for each pair j; even(c), odd(c) are its members of Coefficients c
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

// From a record to its neighbours; a grid of one cell has none.
#define CLPV_DX (CLPV_GRID > 1 ? CLPV_PAIRS : 0)
#define CLPV_DY (CLPV_GRID * CLPV_DX)
#define CLPV_DZ (CLPV_GRID * CLPV_DY)
#define CLPV_CELLS (CLPV_GRID * CLPV_GRID * CLPV_GRID)

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

// One record: the coefficients of a cell, or of a point between cells.
typedef struct {
#define CLPV_DO(j, even, odd) float8 p##j;
  CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
} Packed;

// Trilinear at `at`, in cells from the first cell's centre; points beyond the outermost centres take their value.
// At the last centre the eight cells are those before it, so that their offsets are literals.
CLPV_INLINE Packed clpv_sample(__global const float8* volume, const float3 at) {
  const float3 p = clamp(at, 0.0f, (float)(CLPV_GRID - 1));
  const float3 low = min(floor(p), (float)(CLPV_GRID > 1 ? CLPV_GRID - 2 : 0));
  const float3 t = p - low;
  const int3 cell = convert_int3(low);
  __global const float8* v = volume + ((cell.z * CLPV_GRID + cell.y) * CLPV_GRID + cell.x) * CLPV_PAIRS;
  const float8 tx = t.x, ty = t.y, tz = t.z;
  const float8 w11 = ty * tz, w10 = ty - w11, w01 = tz - w11, w00 = 1.0f - ty - w01;
  const float8 b00 = w00 * tx, b10 = w10 * tx, b01 = w01 * tx, b11 = w11 * tx;
  const float8 a00 = w00 - b00, a10 = w10 - b10, a01 = w01 - b01, a11 = w11 - b11;
  Packed r;
#define CLPV_DO(j, even, odd)                                                                      \
  r.p##j = a00 * v[j] + b00 * v[j + CLPV_DX] + a10 * v[j + CLPV_DY] + b10 * v[j + CLPV_DX + CLPV_DY] + \
           a01 * v[j + CLPV_DZ] + b01 * v[j + CLPV_DX + CLPV_DZ] + a11 * v[j + CLPV_DY + CLPV_DZ] +    \
           b11 * v[j + CLPV_DX + CLPV_DY + CLPV_DZ];
  CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
  return r;
}

// Spelt out: made of two float4, it has lanes that are undefined for a while, which Oclgrind 21.10 crashes on.
#define CLPV_PAIR(a, b) ((float8)(a, a, a, a, b, b, b, b))

// weights . coefficients, a channel.
CLPV_INLINE float3 clpv_weigh(const Coefficients weights, const Packed sampled) {
  float8 sum = 0.0f;
#define CLPV_DO(j, even, odd) \
  sum = fma(CLPV_PAIR(even(weights), odd(weights)), sampled.p##j, sum);
  CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
  return sum.lo.xyz + sum.hi.xyz;
}

// E s^2 of one volume.
CLPV_INLINE float3 clpv_irradiance(__global const float8* volume, const float3 at, const Coefficients weights) {
  const Packed sampled = clpv_sample(volume, at);
  float3 least = 0.0f;
#if CLPV_FLOORED
  least = max(clpv_weigh(clpv_floor_weights(), sampled), 0.0f);
#endif
  return max(clpv_weigh(weights, sampled), least);
}

__kernel void gather(const ClpvView view, __global const float* depths, __global const SurfaceTexel* normals,
                     __global const ClpvGrid* grids, const uint cascades, __global const float8* packed,
                     __global float4* irradiance CLPV_AND_TABLE) {
  const uint px = get_global_id(0), py = get_global_id(1);
  if (px >= view.width || py >= view.height) return;
  const uint pixel = py * view.width + px;
  const float depth = depths[pixel];
  float3 sum = 0.0f;
  if (depth > 0.0f) {
    const float3 position = clpv_position(view, (float)px, (float)py, depth);
    const float3 normal = clpv_load_normal(normals, pixel);
    const Coefficients weights = clpv_gather_weights(normal CLPV_PASS_TABLE);
    float left = 1.0f;  // what finer cascades left to this one
    for (uint c = 0; c < cascades; ++c) {
      const ClpvGrid grid = grids[c];
      const float per_cell = 1.0f / grid.cell;
      const float3 at = (position - clpv_float3(grid.origin)) * per_cell;
      const float3 inside = min(at, (float)CLPV_GRID - at);
      const float share = clamp(fmin(fmin(inside.x, inside.y), inside.z) * CLPV_INVERSE_BLEND, 0.0f, 1.0f);
      if (share == 0.0f) continue;
      const float3 point = at + CLPV_GATHER_OFFSET * normal - 0.5f;
      const float scale = share * per_cell * per_cell;
      __global const float8* volume = packed + (size_t)c * (1 + CLPV_LATE) * CLPV_CELLS * CLPV_PAIRS;
      if (left > 0.0f) sum += scale * left * clpv_irradiance(volume, point, weights);
#if CLPV_LATE
      if (left < 1.0f) {
        sum += scale * (1.0f - left) * clpv_irradiance(volume + CLPV_CELLS * CLPV_PAIRS, point, weights);
      }
#endif
      left *= 1.0f - share;
#if !CLPV_LATE
      if (left == 0.0f) break;
#endif
    }
  }
  irradiance[pixel] = (float4)(sum.x, sum.y, sum.z, 0.0f);
}
