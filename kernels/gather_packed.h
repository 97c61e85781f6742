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

// A cascade: its records and, where cells can be hidden, what kernel `see_triangles` found (see.cl).
typedef struct {
  __global const float8* cells;
#if CLPV_VISIBLE
  __global const uchar* hidden;
#endif
} PackedCascade;

// Trilinear weights of the eight cells round a point, by corner: 1 x, 2 y, 4 z. t: from the lowest one's centre, in cells.
CLPV_INLINE float8 clpv_corner_weights(const float3 t) {
  const float w11 = t.y * t.z, w10 = t.y - w11, w01 = t.z - w11, w00 = 1.0f - t.y - w01;
  const float b00 = w00 * t.x, b10 = w10 * t.x, b01 = w01 * t.x, b11 = w11 * t.x;
  return (float8)(w00 - b00, b00, w10 - b10, b10, w01 - b01, b01, w11 - b11, b11);
}

#if CLPV_VISIBLE
#define CLPV_LEAST_SEEN (1.0f / 64.0f)  // of all weight

// How much of the eight corners is seen: of each point's bits its weight, trilinearly between the points of a cube, so that
// light is continuous; the outermost points hold beyond.
CLPV_INLINE float8 clpv_seen_at(__global const uchar* hidden, const int cube, const float3 t) {
  const float3 p = clamp(t * 4.0f - 0.5f, 0.0f, 3.0f);
  const float3 low = min(floor(p), 2.0f);
  const float8 weights = clpv_corner_weights(p - low);
  const int3 point = convert_int3(low);
  __global const uchar* at = hidden + (size_t)cube * 64 + (point.z * 4 + point.y) * 4 + point.x;
  const int8 bit = (int8)(1, 2, 4, 8, 16, 32, 64, 128);
  float8 seen = 0.0f;
#define CLPV_ADD_SEEN(i, next) seen += ((int8)((int)at[next]) & bit) != 0 ? (float8)(0.0f) : (float8)(weights.s##i);
  CLPV_ADD_SEEN(0, 0) CLPV_ADD_SEEN(1, 1) CLPV_ADD_SEEN(2, 4) CLPV_ADD_SEEN(3, 5)
  CLPV_ADD_SEEN(4, 16) CLPV_ADD_SEEN(5, 17) CLPV_ADD_SEEN(6, 20) CLPV_ADD_SEEN(7, 21)
#undef CLPV_ADD_SEEN
  return seen;
}

// The weights of what is seen, their sum 1; where next to nothing is seen nothing is known, and they stay as they are.
CLPV_INLINE float8 clpv_weights_seen(const float8 weights, const float8 share) {
  const float8 seen = weights * share;
  const float4 pairs = seen.lo + seen.hi;
  const float total = pairs.x + pairs.y + pairs.z + pairs.w;
  return total > CLPV_LEAST_SEEN ? seen * (1.0f / total) : weights;
}
#endif

// Trilinear at `at`, in cells from the first cell's centre; points beyond the outermost centres take their value.
// At the last centre the eight cells are those before it, so that their offsets are literals.
CLPV_INLINE Sampled clpv_sample(const PackedCascade cascade, const float3 at) {
  const float3 p = clamp(at, 0.0f, (float)(CLPV_GRID - 1));
  const float3 low = min(floor(p), (float)(CLPV_GRID > 1 ? CLPV_GRID - 2 : 0));
  const float3 t = p - low;
  const int3 cell = convert_int3(low);
  const int number = (cell.z * CLPV_GRID + cell.y) * CLPV_GRID + cell.x;
  __global const float8* v = cascade.cells + number * CLPV_PAIRS;
  float8 w = clpv_corner_weights(t);
#if CLPV_VISIBLE
  w = clpv_weights_seen(w, clpv_seen_at(cascade.hidden, number, t));
#endif
  Sampled r;
#define CLPV_DO(j, even, odd)                                                                          \
  r.p##j = w.s0 * v[j] + w.s1 * v[j + CLPV_DX] + w.s2 * v[j + CLPV_DY] + w.s3 * v[j + CLPV_DX + CLPV_DY] + \
           w.s4 * v[j + CLPV_DZ] + w.s5 * v[j + CLPV_DX + CLPV_DZ] + w.s6 * v[j + CLPV_DY + CLPV_DZ] +     \
           w.s7 * v[j + CLPV_DX + CLPV_DY + CLPV_DZ];
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
#define CLPV_GATHERED const PackedCascade
#if CLPV_VISIBLE
#define CLPV_GATHERED_VOLUMES , __global const float8 *packed, __global const uchar *hidden
#define CLPV_PACKED_CASCADE(c) \
  { packed + (size_t)c * CLPV_CELLS * CLPV_PAIRS, hidden + (size_t)c * CLPV_CELLS * 64 }
#else
#define CLPV_GATHERED_VOLUMES , __global const float8 *packed
#define CLPV_PACKED_CASCADE(c) \
  { packed + (size_t)c * CLPV_CELLS * CLPV_PAIRS }
#endif
#define CLPV_ADD_CASCADES                                  \
  for (uint c = 0; c < cascades && left > 0.0f; ++c) {     \
    const PackedCascade cascade = CLPV_PACKED_CASCADE(c);  \
    CLPV_ADD_CASCADE(c, cascade);                          \
  }

#endif
