// SPDX-License-Identifier: MIT
// Computes the visibility of cell centres: for sample points between the centres of a cascade's cells, which of the
// eight centres about them a triangle occludes (docs/method.md, 'Gathering').
//
// Eight neighbouring centres are the corners of a cube of edge s. It holds 4 x 4 x 4 points, the centres of cubes of
// edge s / 4. The segment from centre c to point x crosses triangle (v0, v1, v2) if
//
//   n . (x - c) >= n . (v0 - c)             x is behind the plane, n its normal on the side away from c
//   det(v_i - c, v_j - c, x - c) >= -e      for the edges (0, 1), (1, 2), (2, 0): x is inside the pyramid with apex c
//
// with the determinants times the sign of n . (v0 - c). The tolerance e is CLPV_EDGE_TOLERANCE times the edge's L1
// length, so that triangles that share an edge leave no gap. A triangle whose plane contains c does not occlude c. All
// four are linear functions of x.
//
// In:   triangles of the scene in `clusters` (region.h); region: the cubes to test. Masked materials do not occlude.
// Out:  occluded  a byte per point: bit 0 to 7 for the centre offset by (bit & 1, bit >> 1 & 1, bit >> 2); 64 bytes per
//                 cube, points along x first, cubes numbered by their lowest cell
//       cascade   number of the cascade whose bytes to write
// A work-item tests a triangle. Bits are set by atomic_or: results do not depend on the order of triangles. Coordinates
// are in cells, from the lowest centre of a cube. From the host: CLPV_GRID.
#include "lanes.h"
#include "voxels/region.h"
#include "vec.h"

#define CLPV_EDGE_TOLERANCE 1e-3f       // [cells]
#define CLPV_COORDINATE_LIMIT 1e6f      // [cells] coordinates are clamped to it
#define CLPV_FIRST_POINT 0.125f         // of the points along an axis [cells]
#define CLPV_LAST_POINT 0.875f
#define CLPV_LAYERS 4                   // layers of points in a cube, across z

// Points of a layer are tested at once: with eight lanes all 16, with one lane a row of 4, which takes fewer registers.
#if W == 1
typedef float4 Points;
typedef int4 PointBits;
#define CLPV_ROWS 1
#define CLPV_POINTS_X ((float4)(0.125f, 0.375f, 0.625f, 0.875f))
#define CLPV_POINTS_Y ((float4)(0.125f))
#else
typedef float16 Points;
typedef int16 PointBits;
#define CLPV_ROWS 4
#define CLPV_POINTS_X                                                                                           \
  ((float16)(0.125f, 0.375f, 0.625f, 0.875f, 0.125f, 0.375f, 0.625f, 0.875f, 0.125f, 0.375f, 0.625f, 0.875f,     \
             0.125f, 0.375f, 0.625f, 0.875f))
#define CLPV_POINTS_Y                                                                                           \
  ((float16)(0.125f, 0.125f, 0.125f, 0.125f, 0.375f, 0.375f, 0.375f, 0.375f, 0.625f, 0.625f, 0.625f, 0.625f,     \
             0.875f, 0.875f, 0.875f, 0.875f))
#endif

// W of the eight centres, from number `first` on, one per lane.
#define CLPV_CENTRES 8
#define CLPV_CENTRE_X to_realW((first + lane_numbers()) & 1)
#define CLPV_CENTRE_Y to_realW(((first + lane_numbers()) >> 1) & 1)
#define CLPV_CENTRE_Z to_realW((first + lane_numbers()) >> 2)

// A linear function gradient . x + offset of points x, one per centre.
typedef struct {
  Vec gradient;
  realW offset;
} Linear;

static inline float l1_norm(const float3 a) { return fabs(a.x) + fabs(a.y) + fabs(a.z); }

// Maximum over the points of a layer, without the term of the layer's z. The points' square is centred at 1/2.
static inline realW layer_maximum(const Linear f) {
  const float to_side = 0.5f * (CLPV_LAST_POINT - CLPV_FIRST_POINT);
  return 0.5f * (f.gradient.x + f.gradient.y) + to_side * (fabs(f.gradient.x) + fabs(f.gradient.y)) + f.offset;
}

// sign det(a - c, b - c, x - c) + tolerance, for each centre c. The gradient is (a - c) x (b - c) = a x b - c x (b -
// a).
CLPV_INLINE Linear edge_determinant(const float3 a, const float3 b, const int first, const realW sign) {
  const float3 moment = cross(a, b), edge = b - a;
  const realW x = CLPV_CENTRE_X, y = CLPV_CENTRE_Y, z = CLPV_CENTRE_Z;
  const Linear f = {vec(sign * (moment.x - (y * edge.z - z * edge.y)), sign * (moment.y - (z * edge.x - x * edge.z)),
                        sign * (moment.z - (x * edge.y - y * edge.x))),
                    CLPV_EDGE_TOLERANCE * l1_norm(edge) - sign * (moment.x * x + moment.y * y + moment.z * z)};
  return f;
}

// The plane's function and the three determinants, for each centre: a triangle occludes a centre from a point where
// none is negative.
#define CLPV_TESTS 4
typedef struct {
  float x[CLPV_TESTS][W], y[CLPV_TESTS][W];
  float z[CLPV_TESTS][W], offset[CLPV_TESTS][W];
} OcclusionTests;

// Sets up the tests of a triangle for W centres, and for each layer the candidates: bits of the centres
// that it may occlude from any point there.
CLPV_INLINE void set_up_tests(const float3 v0, const float3 v1, const float3 v2, const float3 normal,
                              const int first, OcclusionTests* tests, uint candidates[CLPV_LAYERS]) {
  const realW x = v0.x - CLPV_CENTRE_X, y = v0.y - CLPV_CENTRE_Y, z = v0.z - CLPV_CENTRE_Z;
  const realW distance = normal.x * x + normal.y * y + normal.z * z;
  const realW sign = distance < ZERO ? -ONE : ONE;
  const Linear plane = {vec(sign * normal.x, sign * normal.y, sign * normal.z),
                        -sign * (normal.x * CLPV_CENTRE_X + normal.y * CLPV_CENTRE_Y + normal.z * CLPV_CENTRE_Z) -
                            fabs(distance)};
  const Linear f[CLPV_TESTS] = {plane, edge_determinant(v0, v1, first, sign),
                                edge_determinant(v1, v2, first, sign), edge_determinant(v2, v0, first, sign)};
  // Segments to upper centres lie above the layer, those to lower centres below it.
  const float lowest = fmin(v0.z, fmin(v1.z, v2.z)) - CLPV_EDGE_TOLERANCE;
  const float highest = fmax(v0.z, fmax(v1.z, v2.z)) + CLPV_EDGE_TOLERANCE;
  const realW maximum0 = layer_maximum(f[0]), maximum1 = layer_maximum(f[1]),
               maximum2 = layer_maximum(f[2]), maximum3 = layer_maximum(f[3]);
  for (int layer = 0; layer < CLPV_LAYERS; ++layer) {
    const float at = CLPV_FIRST_POINT + 0.25f * (float)layer;
    const intW may = (distance != ZERO) & (at * f[0].gradient.z + maximum0 >= ZERO) &
                     (at * f[1].gradient.z + maximum1 >= ZERO) & (at * f[2].gradient.z + maximum2 >= ZERO) &
                     (at * f[3].gradient.z + maximum3 >= ZERO);
    candidates[layer] = lane_bits(may) << first & ((at <= highest ? 0xf0u : 0u) | (at >= lowest ? 0x0fu : 0u));
  }
#pragma unroll
  for (int test = 0; test < CLPV_TESTS; ++test) {
    store_lanes(f[test].gradient.x, tests->x[test]);
    store_lanes(f[test].gradient.y, tests->y[test]);
    store_lanes(f[test].gradient.z, tests->z[test]);
    store_lanes(f[test].offset, tests->offset[test]);
  }
}

// Mask of the points at y + CLPV_POINTS_Y of the layer at z where the test of a lane is not negative.
#define CLPV_PASSES(test)                                                                                     \
  (tests->x[test][lane] * CLPV_POINTS_X +                                                                       \
       (tests->y[test][lane] * (y + CLPV_POINTS_Y) +                                                            \
        (Points)(tests->z[test][lane] * z + tests->offset[test][lane])) >=                                    \
   0.0f)

// Bits of the candidates that the triangle occludes, for each of these points.
CLPV_INLINE PointBits find_occluded(const OcclusionTests* tests, const int first, uint candidates, const float y,
                                    const float z) {
  PointBits occluded = (PointBits)(0);
  while (candidates != 0) {
    const int corner = 31 - (int)clz(candidates), lane = W == 1 ? 0 : corner - first;
    candidates ^= 1u << corner;
    const PointBits crossed = CLPV_PASSES(0) & CLPV_PASSES(1) & CLPV_PASSES(2) & CLPV_PASSES(3);
    occluded |= crossed & (1 << corner);
  }
  return occluded;
}

static inline void set_word(__global volatile uint* word, const uint bits) {
  if (bits != 0) atomic_or(word, bits);
}

// Sets the bits of CLPV_ROWS rows of points, a word each.
static inline void set_bits(__global volatile uint* words, const PointBits bits) {
#if W == 1
  set_word(words, as_uint(convert_uchar4(bits)));
#else
  const uint4 of_rows = as_uint4(convert_uchar16(bits));
  set_word(words, of_rows.x);
  set_word(words + 1, of_rows.y);
  set_word(words + 2, of_rows.z);
  set_word(words + 3, of_rows.w);
#endif
}

// Tests a triangle in one cube. `points`: the cube's 64 bytes.
static inline void occlude_cube(const float3 v0, const float3 v1, const float3 v2, const float3 normal,
                                __global volatile uint* points) {
#pragma unroll 1
  for (int first = 0; first < CLPV_CENTRES; first += W) {
    OcclusionTests tests;
    uint candidates[CLPV_LAYERS];
    set_up_tests(v0, v1, v2, normal, first, &tests, candidates);
#pragma unroll
    for (int layer = 0; layer < CLPV_LAYERS; ++layer) {
      if (candidates[layer] == 0) continue;
      const float z = CLPV_FIRST_POINT + 0.25f * (float)layer;
#pragma unroll 1
      for (int row = 0; row < 4; row += CLPV_ROWS)
        set_bits(points + 4 * layer + row, find_occluded(&tests, first, candidates[layer], 0.25f * (float)row, z));
    }
  }
}

// Position of a vertex in cells, from the centre of the cell at the region's base.
static inline float3 to_cells(const ClpvRegion* region, __global const ClpvVertex* vertex) {
  const float3 position = (float3)(vertex->position[0], vertex->position[1], vertex->position[2]);
  const float3 base = (float3)(region->base[0], region->base[1], region->base[2]);
  return clamp((position - base) / region->cell - 0.5f, -CLPV_COORDINATE_LIMIT, CLPV_COORDINATE_LIMIT);
}

__kernel void occlude_cells(const ClpvRegion region, __global const uint* clusters, const uint first_cluster,
                            const uint cluster_count, const uint triangle_count, __global const ClpvVertex* vertices,
                            __global const ClpvTriangle* triangles, __global const ClpvMaterial* materials,
                            __global uint* occluded, const uint cascade) {
  const uint number = triangle_number(clusters, first_cluster, cluster_count, triangle_count);
  if (number >= triangle_count) return;
  const ClpvTriangle triangle = triangles[number];
  if ((materials[triangle.material].flags & CLPV_MATERIAL_MASKED) != 0) return;
  const float3 v0 = to_cells(&region, vertices + triangle.vertex[0]);
  const float3 v1 = to_cells(&region, vertices + triangle.vertex[1]);
  const float3 v2 = to_cells(&region, vertices + triangle.vertex[2]);
  const float3 normal = cross(v1 - v0, v2 - v0);
  const int3 first = (int3)(region.first[0], region.first[1], region.first[2]);
  const int3 lowest = (int3)(region.all.low[0], region.all.low[1], region.all.low[2]);
  const int3 highest = (int3)(region.all.high[0], region.all.high[1], region.all.high[2]);
  const int3 low = max(convert_int3(floor(fmin(v0, fmin(v1, v2)))) - first, lowest);
  const int3 high = min(convert_int3(floor(fmax(v0, fmax(v1, v2)))) - first, highest);
  const float half_extent = 0.5f * l1_norm(normal);  // of a cube along the normal, times its length
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        const float3 cube = convert_float3((int3)(x, y, z) + first);
        if (fabs(dot(normal, cube + 0.5f - v0)) > half_extent || !in_region(&region, x, y, z)) continue;
        occlude_cube(v0 - cube, v1 - cube, v2 - cube, normal,
                     occluded + 16 * (((size_t)cascade * CLPV_GRID + z) * CLPV_GRID + y) * CLPV_GRID + 16 * x);
      }
    }
  }
}
