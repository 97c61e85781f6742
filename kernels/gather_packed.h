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

// A cascade: its records and, where cells can be hidden, what kernel `hide_cells` found (visibility.cl).
typedef struct {
  __global const float8* cells;
#if CLPV_VISIBLE
  __global const uchar* hidden;
#endif
} PackedCascade;

// Eight points: the cells round each, from `number` on (the lowest one's), and where the point lies between their centres;
// with CLPV_VISIBLE the same of the points round it that visibility.cl looked from.
typedef struct {
  int number[CLPV_ABREAST];
  float x[CLPV_ABREAST], y[CLPV_ABREAST], z[CLPV_ABREAST];
#if CLPV_VISIBLE
  int seen_from[CLPV_ABREAST];
  float seen_x[CLPV_ABREAST], seen_y[CLPV_ABREAST], seen_z[CLPV_ABREAST];
#endif
} Places;

// At the last centre the eight cells are those before it, so that their offsets are literals.
CLPV_INLINE void clpv_places(const Vec at, Places* places) {
  const float last = (float)(CLPV_GRID - 1);
  const int8 highest = (int8)(CLPV_GRID > 1 ? CLPV_GRID - 2 : 0);
  const Vec p = vec(clpv_within(at.x, last), clpv_within(at.y, last), clpv_within(at.z, last));
  const int8 x = min(convert_int8(p.x), highest), y = min(convert_int8(p.y), highest),
             z = min(convert_int8(p.z), highest);
  const Vec t = vec(p.x - convert_float8(x), p.y - convert_float8(y), p.z - convert_float8(z));
  const int8 number = (z * CLPV_GRID + y) * CLPV_GRID + x;
  vstore8(number, 0, places->number);
  vstore8(t.x, 0, places->x), vstore8(t.y, 0, places->y), vstore8(t.z, 0, places->z);
#if CLPV_VISIBLE
  const Vec q = vec(clpv_within(t.x * 4.0f - 0.5f, 3.0f), clpv_within(t.y * 4.0f - 0.5f, 3.0f),
                    clpv_within(t.z * 4.0f - 0.5f, 3.0f));
  const int8 qx = min(convert_int8(q.x), (int8)(2)), qy = min(convert_int8(q.y), (int8)(2)),
             qz = min(convert_int8(q.z), (int8)(2));
  vstore8(number * 64 + (qz * 4 + qy) * 4 + qx, 0, places->seen_from);
  vstore8(q.x - convert_float8(qx), 0, places->seen_x);
  vstore8(q.y - convert_float8(qy), 0, places->seen_y);
  vstore8(q.z - convert_float8(qz), 0, places->seen_z);
#endif
}

// Trilinear weights of the eight corners round a point (x, y, z) between them: 1 x, 2 y, 4 z.
CLPV_INLINE float8 clpv_corner_weights(const float x, const float y, const float z) {
  const float8 along_x = fma((float8)(-1, 1, -1, 1, -1, 1, -1, 1), (float8)(x), (float8)(1, 0, 1, 0, 1, 0, 1, 0));
  const float8 along_y = fma((float8)(-1, -1, 1, 1, -1, -1, 1, 1), (float8)(y), (float8)(1, 1, 0, 0, 1, 1, 0, 0));
  const float8 along_z = fma((float8)(-1, -1, -1, -1, 1, 1, 1, 1), (float8)(z), (float8)(1, 1, 1, 1, 0, 0, 0, 0));
  return along_x * along_y * along_z;
}

#if CLPV_VISIBLE
#define CLPV_LEAST_SEEN (1.0f / 64.0f)  // of all weight

// How much of the eight corners is seen: of each point's bits its weight, trilinearly between the points of a cube, so that
// light is continuous; the outermost points hold beyond.
CLPV_INLINE float8 clpv_seen_at(__global const uchar* at, const float8 weights) {
  const int8 bit = (int8)(1, 2, 4, 8, 16, 32, 64, 128);
  float8 seen = 0.0f;
#define CLPV_ADD_SEEN(i, next) seen += ((int8)((int)at[next]) & bit) != 0 ? (float8)(0.0f) : (float8)(weights.s##i);
  CLPV_ADD_SEEN(0, 0) CLPV_ADD_SEEN(1, 1) CLPV_ADD_SEEN(2, 4) CLPV_ADD_SEEN(3, 5)
  CLPV_ADD_SEEN(4, 16) CLPV_ADD_SEEN(5, 17) CLPV_ADD_SEEN(6, 20) CLPV_ADD_SEEN(7, 21)
#undef CLPV_ADD_SEEN
  return seen;
}

// Leaves the weights of what is seen, and returns what brings their sum to 1; where next to nothing is seen nothing is
// known, and they stay as they are.
CLPV_INLINE float clpv_see(const PackedCascade cascade, const Places* places, const int i, float8* weights) {
  const float8 from = clpv_corner_weights(places->seen_x[i], places->seen_y[i], places->seen_z[i]);
  const float8 seen = *weights * clpv_seen_at(cascade.hidden + places->seen_from[i], from);
  const float4 pairs = seen.lo + seen.hi;
  const float total = pairs.x + pairs.y + pairs.z + pairs.w;
  if (!(total > CLPV_LEAST_SEEN)) return 1.0f;
  *weights = seen;
  return 1.0f / total;
}
#endif

CLPV_INLINE float clpv_sample(const PackedCascade cascade, const Places* places, const int i, Sampled* r) {
  __global const float8* v = cascade.cells + places->number[i] * CLPV_PAIRS;
  float8 w = clpv_corner_weights(places->x[i], places->y[i], places->z[i]);
  float scale = 1.0f;
#if CLPV_VISIBLE
  scale = clpv_see(cascade, places, i, &w);
#endif
#define CLPV_DO(j, even, odd)                                                                          \
  r->p##j = w.s0 * v[j] + w.s1 * v[j + CLPV_DX] + w.s2 * v[j + CLPV_DY] + w.s3 * v[j + CLPV_DX + CLPV_DY] + \
           w.s4 * v[j + CLPV_DZ] + w.s5 * v[j + CLPV_DX + CLPV_DZ] + w.s6 * v[j + CLPV_DY + CLPV_DZ] +     \
           w.s7 * v[j + CLPV_DX + CLPV_DY + CLPV_DZ];
  CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
  return scale;
}

// Spelt out: made of two float4, it has lanes that are undefined for a while, which Oclgrind 21.10 crashes on.
#define CLPV_PAIR(a, b) ((float8)(a, a, a, a, b, b, b, b))

CLPV_INLINE float4 clpv_weigh(const Coefficients weights, const Sampled sampled) {
  float8 sum = 0.0f;
#define CLPV_DO(j, even, odd) sum = fma(CLPV_PAIR(even(weights), odd(weights)), sampled.p##j, sum);
  CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
  return sum.lo + sum.hi;
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
  for (uint c = 0; c < cascades; ++c) {                    \
    const PackedCascade cascade = CLPV_PACKED_CASCADE(c);  \
    CLPV_ADD_CASCADE(c, cascade);                          \
  }

#endif
