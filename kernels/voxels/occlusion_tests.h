// SPDX-License-Identifier: MIT
// Tests of a triangle against the points of a cube and the eight cell centres at its corners: which
// centres it occludes from a point (visibility.cl has the formulas).
#pragma once

#include "lanes.h"
#include "vec.h"

__constant const float edge_tolerance = 1e-3f;  // [cells]
__constant const float coordinate_limit = 1e6f;  // [cells] coordinates are clamped to it
__constant const float first_point = 0.125f;  // first of the points along an axis [cells]
__constant const float last_point = 0.875f;
enum { CLPV_LAYERS = 4 };  // layers of points in a cube, across z

// Points of a layer are tested at once: with eight lanes all 16, with one lane a row of 4, which
// takes fewer registers.
#if W == 1
typedef float4 Points;
typedef int4 PointBits;
enum { CLPV_ROWS = 1 };
__constant const Points points_x = (float4)(0.125f, 0.375f, 0.625f, 0.875f);
__constant const Points points_y = (float4)(0.125f, 0.125f, 0.125f, 0.125f);
#else
typedef float16 Points;
typedef int16 PointBits;
enum { CLPV_ROWS = 4 };
__constant const Points points_x = (float16)(
    0.125f, 0.375f, 0.625f, 0.875f, 0.125f, 0.375f, 0.625f, 0.875f, 0.125f, 0.375f, 0.625f, 0.875f,
    0.125f, 0.375f, 0.625f, 0.875f);
__constant const Points points_y = (float16)(
    0.125f, 0.125f, 0.125f, 0.125f, 0.375f, 0.375f, 0.375f, 0.375f, 0.625f, 0.625f, 0.625f, 0.625f,
    0.875f, 0.875f, 0.875f, 0.875f);
#endif

// W of the eight centres, from number `first` on, one per lane.
enum { CLPV_CENTRES = 8 };
static inline Vec find_centres(const int first) {
  const intW number = first + lane_numbers();
  return vec(to_realW(number & 1), to_realW((number >> 1) & 1), to_realW(number >> 2));
}

// A linear function gradient . x + offset of points x, one per centre.
typedef struct {
  Vec gradient;
  realW offset;
} Linear;

static inline float l1_norm(const float3 a) { return fabs(a.x) + fabs(a.y) + fabs(a.z); }

// Maximum over the points of a layer, without the term of the layer's z. The points' square is
// centred at 1/2.
static inline realW layer_maximum(const Linear f) {
  const float to_side = 0.5f * (last_point - first_point);
  return 0.5f * (f.gradient.x + f.gradient.y) +
         to_side * (fabs(f.gradient.x) + fabs(f.gradient.y)) + f.offset;
}

// sign det(a - c, b - c, x - c) + tolerance, for each centre c. The gradient is (a - c) x (b - c) =
// a x b - c x (b - a).
CLPV_INLINE Linear edge_determinant(const float3 a, const float3 b, const int first,
                                    const realW sign) {
  const float3 moment = cross(a, b), edge = b - a;
  const Vec c = find_centres(first);
  const Linear f = {
      vec(sign * (moment.x - (c.y * edge.z - c.z * edge.y)),
          sign * (moment.y - (c.z * edge.x - c.x * edge.z)),
          sign * (moment.z - (c.x * edge.y - c.y * edge.x))),
      edge_tolerance * l1_norm(edge) - sign * (moment.x * c.x + moment.y * c.y + moment.z * c.z)};
  return f;
}

// Per centre four linear functions: the plane and three determinants. The triangle hides the centre
// from points where none of the four is negative.
enum { CLPV_TESTS = 4 };
typedef struct {
  float x[CLPV_TESTS][W], y[CLPV_TESTS][W];
  float z[CLPV_TESTS][W], offset[CLPV_TESTS][W];
} OcclusionTests;

// Sets up the tests of a triangle for W centres, and for each layer the candidates: bits of the
// centres that it may occlude from any point there.
CLPV_INLINE void set_up_tests(const float3 v0, const float3 v1, const float3 v2,
                              const float3 normal, const int first, OcclusionTests* tests,
                              uint candidates[CLPV_LAYERS]) {
  const Vec c = find_centres(first);
  const realW x = v0.x - c.x, y = v0.y - c.y, z = v0.z - c.z;
  const realW distance = normal.x * x + normal.y * y + normal.z * z;
  const realW sign = distance < ZERO ? -ONE : ONE;
  const Linear plane = {
      vec(sign * normal.x, sign * normal.y, sign * normal.z),
      -sign * (normal.x * c.x + normal.y * c.y + normal.z * c.z) - fabs(distance)};
  const Linear f[CLPV_TESTS] = {plane, edge_determinant(v0, v1, first, sign),
                                edge_determinant(v1, v2, first, sign),
                                edge_determinant(v2, v0, first, sign)};
  // Segments to upper centres lie above the layer, those to lower centres below it.
  const float lowest = fmin(v0.z, fmin(v1.z, v2.z)) - edge_tolerance;
  const float highest = fmax(v0.z, fmax(v1.z, v2.z)) + edge_tolerance;
  const realW maximum0 = layer_maximum(f[0]), maximum1 = layer_maximum(f[1]),
               maximum2 = layer_maximum(f[2]), maximum3 = layer_maximum(f[3]);
  for (int layer = 0; layer < CLPV_LAYERS; ++layer) {
    const float at = first_point + 0.25f * (float)layer;
    const intW may = (distance != ZERO) & (at * f[0].gradient.z + maximum0 >= ZERO) &
                     (at * f[1].gradient.z + maximum1 >= ZERO) &
                     (at * f[2].gradient.z + maximum2 >= ZERO) &
                     (at * f[3].gradient.z + maximum3 >= ZERO);
    candidates[layer] =
        lane_bits(may) << first & ((at <= highest ? 0xf0u : 0u) | (at >= lowest ? 0x0fu : 0u));
  }
#pragma unroll
  for (int test = 0; test < CLPV_TESTS; ++test) {
    store_lanes(f[test].gradient.x, tests->x[test]);
    store_lanes(f[test].gradient.y, tests->y[test]);
    store_lanes(f[test].gradient.z, tests->z[test]);
    store_lanes(f[test].offset, tests->offset[test]);
  }
}

// Mask of the points at y + points_y of the layer at z where a test of a lane is not negative.
CLPV_INLINE PointBits passes(const OcclusionTests* tests, const int test, const int lane,
                             const float y, const float z) {
  return tests->x[test][lane] * points_x +
             (tests->y[test][lane] * (y + points_y) +
              (Points)(tests->z[test][lane] * z + tests->offset[test][lane])) >=
         0.0f;
}

// Bits of the candidates that the triangle occludes, for each of these points.
CLPV_INLINE PointBits find_occluded(const OcclusionTests* tests, const int first, uint candidates,
                                    const float y, const float z) {
  PointBits occluded = (PointBits)(0);
  while (candidates != 0) {
    const int corner = 31 - (int)clz(candidates), lane = W == 1 ? 0 : corner - first;
    candidates ^= 1u << corner;
    const PointBits crossed = passes(tests, 0, lane, y, z) & passes(tests, 1, lane, y, z) &
                              passes(tests, 2, lane, y, z) & passes(tests, 3, lane, y, z);
    occluded |= crossed & (1 << corner);
  }
  return occluded;
}
