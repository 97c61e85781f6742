// SPDX-License-Identifier: MIT
// Gathering from records that kernel `pack` made of a cascade's volume: CLPV_PAIRS float8 a cell, each two numbers as
// (r g b 0)(r g b 0). Kernel `gather` then reads the eight cells round a point as whole vectors, where planes would take
// 24 scalar reads a number.
//
// The host writes CLPV_EACH_PAIR(DO), which writes DO(j, even, odd) for each pair j; even(c), odd(c) are its members of
// Coefficients c.
#ifndef CLPV_GATHER_PACKED_H
#define CLPV_GATHER_PACKED_H

// From a record to its neighbours; a grid of one cell has none.
#define CLPV_DX (CLPV_GRID > 1 ? CLPV_PAIRS : 0)
#define CLPV_DY (CLPV_GRID * CLPV_DX)
#define CLPV_DZ (CLPV_GRID * CLPV_DY)
#define CLPV_CELLS (CLPV_GRID * CLPV_GRID * CLPV_GRID)

// One record: the coefficients of a cell, or of a point between cells.
typedef struct {
#define CLPV_DO(j, even, odd) float8 p##j;
  CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
} Sampled;

// Trilinear at `at`, in cells from the first cell's centre; points beyond the outermost centres take their value.
// At the last centre the eight cells are those before it, so that their offsets are literals.
CLPV_INLINE Sampled clpv_sample(__global const float8* volume, const float3 at) {
  const float3 p = clamp(at, 0.0f, (float)(CLPV_GRID - 1));
  const float3 low = min(floor(p), (float)(CLPV_GRID > 1 ? CLPV_GRID - 2 : 0));
  const float3 t = p - low;
  const int3 cell = convert_int3(low);
  __global const float8* v = volume + ((cell.z * CLPV_GRID + cell.y) * CLPV_GRID + cell.x) * CLPV_PAIRS;
  const float8 tx = t.x, ty = t.y, tz = t.z;
  const float8 w11 = ty * tz, w10 = ty - w11, w01 = tz - w11, w00 = 1.0f - ty - w01;
  const float8 b00 = w00 * tx, b10 = w10 * tx, b01 = w01 * tx, b11 = w11 * tx;
  const float8 a00 = w00 - b00, a10 = w10 - b10, a01 = w01 - b01, a11 = w11 - b11;
  Sampled r;
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

CLPV_INLINE float3 clpv_weigh(const Coefficients weights, const Sampled sampled) {
  float8 sum = 0.0f;
#define CLPV_DO(j, even, odd) \
  sum = fma(CLPV_PAIR(even(weights), odd(weights)), sampled.p##j, sum);
  CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
  return sum.lo.xyz + sum.hi.xyz;
}

// The packed volumes of all cascades in one buffer, finest first.
#define CLPV_GATHERED __global const float8*
#define CLPV_GATHERED_VOLUMES , CLPV_GATHERED packed
#define CLPV_ADD_CASCADES                                                                                \
  for (uint c = 0; c < cascades && left > 0.0f; ++c) {                                                   \
    CLPV_ADD_CASCADE(c, packed + (size_t)c * CLPV_CELLS * CLPV_PAIRS);                                   \
  }

#endif
