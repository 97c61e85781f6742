// SPDX-License-Identifier: MIT
// What a scene's triangles hide: for points between the centres of a cascade's cells, which of the eight cells round them
// are hidden (docs/method.md, 'Gathering').
//
// The eight centres next to each other are the corners of a cube of edge s. In it stand 4 x 4 x 4 points, those of the
// same number of cubes of edge s / 4. Out: a byte a point, bit `corner` (1 x, 2 y, 4 z) set where a triangle crosses the
// way from the point to that centre; 64 bytes a cube, points along x first; cubes counted by their least corner's cell.
// Bits are set by atomic_or, so that the order of triangles does not matter.
//
// Coordinates are in cells from the cube's least corner. The way from centre c to point x crosses triangle (v0, v1, v2)
// where x lies beyond its plane and inside the three planes through c and an edge: det(v_i - c, v_j - c, x - c) has the
// sign that the plane's distance from c has. Inside counts up to CLPV_SEE_SEAM outside, so that triangles that share an edge
// leave no gap. What lies in the very plane of c hides nothing from it.
//
// Triangles of masked materials hide nothing: holes are finer than what is asked here.
#include "lanes.h"
#include "region.h"
#include "vec.h"

#define CLPV_SEE_SEAM 1e-3f     // [cells]
#define CLPV_SEE_FAR 1e6f       // [cells] where coordinates are kept
#define CLPV_SEE_FIRST 0.125f   // of the points along an axis, the first one
#define CLPV_SEE_LAST 0.875f
#define CLPV_SEE_LAYERS 4

#define CLPV_POINTS_X ((float16)(.125f, .375f, .625f, .875f, .125f, .375f, .625f, .875f, .125f, .375f, .625f, .875f, \
                                 .125f, .375f, .625f, .875f))
#define CLPV_POINTS_Y ((float16)(.125f, .125f, .125f, .125f, .375f, .375f, .375f, .375f, .625f, .625f, .625f, .625f, \
                                 .875f, .875f, .875f, .875f))

// The eight centres, corner by corner.
#define CLPV_CENTRE_X ((float8)(0, 1, 0, 1, 0, 1, 0, 1))
#define CLPV_CENTRE_Y ((float8)(0, 0, 1, 1, 0, 0, 1, 1))
#define CLPV_CENTRE_Z ((float8)(0, 0, 0, 0, 1, 1, 1, 1))

// For each centre a . x + offset: a linear function of points x.
typedef struct {
  Vec a;
  float8 offset;
} Linear;

static inline float clpv_breadth(const float3 a) { return fabs(a.x) + fabs(a.y) + fabs(a.z); }

// The largest value of each over a layer's points, less what the layer's z adds: their square has its middle at 1/2.
static inline float8 clpv_most(const Linear f) {
  const float to_side = 0.5f * (CLPV_SEE_LAST - CLPV_SEE_FIRST);
  return 0.5f * (f.a.x + f.a.y) + to_side * (fabs(f.a.x) + fabs(f.a.y)) + f.offset;
}

// The planes through each centre and an edge from a to b, positive on the triangle's inner side; the seam included.
CLPV_INLINE Linear clpv_edges(const float3 a, const float3 b, const float8 side) {
  const float3 moment = cross(a, b), edge = b - a;
  const float8 x = CLPV_CENTRE_X, y = CLPV_CENTRE_Y, z = CLPV_CENTRE_Z;
  const Linear f = {vec(side * (moment.x - (y * edge.z - z * edge.y)), side * (moment.y - (z * edge.x - x * edge.z)),
                        side * (moment.z - (x * edge.y - y * edge.x))),
                    CLPV_SEE_SEAM * clpv_breadth(edge) - side * (moment.x * x + moment.y * y + moment.z * z)};
  return f;
}

// The functions of the centres whose signs tell what a triangle hides: of its plane, and of its three edges.
#define CLPV_SEE_SIGNS 4
typedef struct {
  float x[CLPV_SEE_SIGNS][CLPV_ABREAST], y[CLPV_SEE_SIGNS][CLPV_ABREAST];
  float z[CLPV_SEE_SIGNS][CLPV_ABREAST], offset[CLPV_SEE_SIGNS][CLPV_ABREAST];
} Signs;

// The signs of a triangle, and for each layer the centres, a bit each, that it may hide from any point there.
CLPV_INLINE void clpv_signs(const float3 v0, const float3 v1, const float3 v2, const float3 normal, Signs* signs,
                            uint wanted[CLPV_SEE_LAYERS]) {
  const float8 zero = (float8)(0.0f), one = (float8)(1.0f);
  const float8 x = v0.x - CLPV_CENTRE_X, y = v0.y - CLPV_CENTRE_Y, z = v0.z - CLPV_CENTRE_Z;
  const float8 distance = normal.x * x + normal.y * y + normal.z * z;
  const float8 side = distance < zero ? -one : one;
  const Linear plane = {vec(side * normal.x, side * normal.y, side * normal.z),
                        -side * (normal.x * CLPV_CENTRE_X + normal.y * CLPV_CENTRE_Y + normal.z * CLPV_CENTRE_Z) -
                            fabs(distance)};
  const Linear f[CLPV_SEE_SIGNS] = {plane, clpv_edges(v0, v1, side), clpv_edges(v1, v2, side), clpv_edges(v2, v0, side)};
  // Points on the centre's side of the whole triangle are not behind it.
  const float lowest = fmin(v0.z, fmin(v1.z, v2.z)) - CLPV_SEE_SEAM, highest = fmax(v0.z, fmax(v1.z, v2.z)) + CLPV_SEE_SEAM;
  const float8 most0 = clpv_most(f[0]), most1 = clpv_most(f[1]), most2 = clpv_most(f[2]), most3 = clpv_most(f[3]);
  for (int layer = 0; layer < CLPV_SEE_LAYERS; ++layer) {
    const float at = CLPV_SEE_FIRST + 0.25f * (float)layer;
    const int8 may = (distance != zero) & (at * f[0].a.z + most0 >= zero) & (at * f[1].a.z + most1 >= zero) &
                     (at * f[2].a.z + most2 >= zero) & (at * f[3].a.z + most3 >= zero);
    wanted[layer] = clpv_bits(may) & ((at <= highest ? 0xf0u : 0u) | (at >= lowest ? 0x0fu : 0u));
  }
#pragma unroll
  for (int which = 0; which < CLPV_SEE_SIGNS; ++which) {
    vstore8(f[which].a.x, 0, signs->x[which]);
    vstore8(f[which].a.y, 0, signs->y[which]);
    vstore8(f[which].a.z, 0, signs->z[which]);
    vstore8(f[which].offset, 0, signs->offset[which]);
  }
}

// The points of a layer at which a function of a centre is not negative.
#define CLPV_NOT_NEGATIVE(which)                                                         \
  (signs->x[which][corner] * CLPV_POINTS_X +                                             \
       (signs->y[which][corner] * CLPV_POINTS_Y +                                        \
        (float16)(signs->z[which][corner] * z + signs->offset[which][corner])) >=        \
   0.0f)

// For the points of the layer at z the centres that a triangle hides from them, of those `wanted`.
CLPV_INLINE int16 clpv_hide(const Signs* signs, uint wanted, const float z) {
  int16 hidden = (int16)(0);
  while (wanted != 0) {
    const int corner = 31 - (int)clz(wanted);
    wanted ^= 1u << corner;
    const int16 crossed = CLPV_NOT_NEGATIVE(0) & CLPV_NOT_NEGATIVE(1) & CLPV_NOT_NEGATIVE(2) & CLPV_NOT_NEGATIVE(3);
    hidden |= crossed & (1 << corner);
  }
  return hidden;
}

static inline void clpv_set_word(__global volatile uint* word, const uint bits) {
  if (bits != 0) atomic_or(word, bits);
}

// A triangle in one cube.
static inline void clpv_see_cube(const float3 v0, const float3 v1, const float3 v2, const float3 normal,
                                 __global volatile uint* points) {
  Signs signs;
  uint wanted[CLPV_SEE_LAYERS];
  clpv_signs(v0, v1, v2, normal, &signs, wanted);
  for (int layer = 0; layer < CLPV_SEE_LAYERS; ++layer) {
    if (wanted[layer] == 0) continue;
    const int16 hidden = clpv_hide(&signs, wanted[layer], CLPV_SEE_FIRST + 0.25f * (float)layer);
    const uint4 bits = as_uint4(convert_uchar16(hidden));
    clpv_set_word(points + 4 * layer, bits.x);
    clpv_set_word(points + 4 * layer + 1, bits.y);
    clpv_set_word(points + 4 * layer + 2, bits.z);
    clpv_set_word(points + 4 * layer + 3, bits.w);
  }
}

// In cells from the centre of the region's cell 0.
static inline float3 clpv_see_at(const ClpvRegion* region, __global const ClpvVertex* vertex) {
  const float3 position = (float3)(vertex->position[0], vertex->position[1], vertex->position[2]);
  const float3 base = (float3)(region->base[0], region->base[1], region->base[2]);
  return clamp((position - base) / region->cell - 0.5f, -CLPV_SEE_FAR, CLPV_SEE_FAR);
}

// A work-item is a triangle; `cascade`: whose bytes these are.
__kernel void hide_cells(const ClpvRegion region, CLPV_TRIANGLES, __global uint* hidden, const uint cascade) {
  const uint number = CLPV_TRIANGLE_NUMBER;
  if (number >= triangle_count) return;
  const ClpvTriangle triangle = triangles[number];
  if ((materials[triangle.material].flags & CLPV_MATERIAL_MASKED) != 0) return;
  const float3 v0 = clpv_see_at(&region, vertices + triangle.vertex[0]);
  const float3 v1 = clpv_see_at(&region, vertices + triangle.vertex[1]);
  const float3 v2 = clpv_see_at(&region, vertices + triangle.vertex[2]);
  const float3 normal = cross(v1 - v0, v2 - v0);
  const int3 first = (int3)(region.first[0], region.first[1], region.first[2]);
  const int3 least = (int3)(region.all.low[0], region.all.low[1], region.all.low[2]);
  const int3 most = (int3)(region.all.high[0], region.all.high[1], region.all.high[2]);
  const int3 low = max(convert_int3(floor(fmin(v0, fmin(v1, v2)))) - first, least);
  const int3 high = min(convert_int3(floor(fmax(v0, fmax(v1, v2)))) - first, most);
  const float half_slab = 0.5f * clpv_breadth(normal);
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        const float3 cube = convert_float3((int3)(x, y, z) + first);
        if (fabs(dot(normal, cube + 0.5f - v0)) > half_slab || !clpv_in_region(&region, x, y, z)) continue;
        clpv_see_cube(v0 - cube, v1 - cube, v2 - cube, normal,
                      hidden + 16 * (((size_t)cascade * CLPV_GRID + z) * CLPV_GRID + y) * CLPV_GRID + 16 * x);
      }
    }
  }
}
