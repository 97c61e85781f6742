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
#include "region.h"

#define CLPV_SEE_SEAM 1e-3f     // [cells]
#define CLPV_SEE_FAR 1e6f       // [cells] where coordinates are kept
#define CLPV_SEE_FIRST 0.125f   // of the points along an axis, the first one
#define CLPV_SEE_LAST 0.875f
#define CLPV_SEE_LAYERS 4

#define CLPV_POINTS_X ((float16)(.125f, .375f, .625f, .875f, .125f, .375f, .625f, .875f, .125f, .375f, .625f, .875f, \
                                 .125f, .375f, .625f, .875f))
#define CLPV_POINTS_Y ((float16)(.125f, .125f, .125f, .125f, .375f, .375f, .375f, .375f, .625f, .625f, .625f, .625f, \
                                 .875f, .875f, .875f, .875f))

// a . x + offset: a linear function of the points of a layer.
typedef struct {
  float3 a;
  float offset;
} Linear;

static inline float16 clpv_layer(const Linear f, const float z) {
  return f.a.x * CLPV_POINTS_X + (f.a.y * CLPV_POINTS_Y + (f.a.z * z + f.offset));
}

// The largest value of side a . (x - c) over all points.
static inline float clpv_reach(const float3 a, const float3 c) {
  const float3 first = a * (CLPV_SEE_FIRST - c), last = a * (CLPV_SEE_LAST - c);
  const float3 most = fmax(first, last);
  return most.x + most.y + most.z;
}

static inline float clpv_breadth(const float3 a) { return fabs(a.x) + fabs(a.y) + fabs(a.z); }

// The plane through centre c and an edge from a to b, positive on the triangle's inner side; the seam included.
static inline Linear clpv_edge(const float3 a, const float3 b, const float3 c, const float side) {
  const float3 moment = cross(a, b), edge = b - a;
  const Linear f = {side * (moment - cross(c, edge)), CLPV_SEE_SEAM * clpv_breadth(edge) - side * dot(moment, c)};
  return f;
}

// Adds the bit of `corner` to the points from which a triangle hides it.
static inline void clpv_hide(const float3 v0, const float3 v1, const float3 v2, const float3 normal, const int corner,
                             int16 hidden[CLPV_SEE_LAYERS]) {
  const float3 c = (float3)((float)(corner & 1), (float)(corner >> 1 & 1), (float)(corner >> 2));
  const float distance = dot(normal, v0 - c);
  const float side = distance < 0.0f ? -1.0f : 1.0f;
  if (distance == 0.0f || clpv_reach(side * normal, c) < fabs(distance)) return;
  const Linear plane = {side * normal, -side * dot(normal, c) - fabs(distance)};
  const Linear e0 = clpv_edge(v0, v1, c, side), e1 = clpv_edge(v1, v2, c, side), e2 = clpv_edge(v2, v0, c, side);
  // Points on the centre's side of the whole triangle are not behind it.
  const float near_z = corner & 4 ? fmax(v0.z, fmax(v1.z, v2.z)) : fmin(v0.z, fmin(v1.z, v2.z));
  for (int layer = 0; layer < CLPV_SEE_LAYERS; ++layer) {
    const float z = CLPV_SEE_FIRST + 0.25f * (float)layer;
    if (corner & 4 ? z > near_z + CLPV_SEE_SEAM : z < near_z - CLPV_SEE_SEAM) continue;
    const int16 crossed = (clpv_layer(plane, z) >= 0.0f) & (clpv_layer(e0, z) >= 0.0f) &
                          (clpv_layer(e1, z) >= 0.0f) & (clpv_layer(e2, z) >= 0.0f);
    hidden[layer] |= crossed & (1 << corner);
  }
}

static inline void clpv_set_word(__global volatile uint* word, const uint bits) {
  if (bits != 0) atomic_or(word, bits);
}

// A triangle in one cube.
static inline void clpv_see_cube(const float3 v0, const float3 v1, const float3 v2, const float3 normal,
                                 __global volatile uint* points) {
  int16 hidden[CLPV_SEE_LAYERS] = {0, 0, 0, 0};
  for (int corner = 0; corner < 8; ++corner) clpv_hide(v0, v1, v2, normal, corner, hidden);
  for (int layer = 0; layer < CLPV_SEE_LAYERS; ++layer) {
    const uint4 bits = as_uint4(convert_uchar16(hidden[layer]));
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
__kernel void see_triangles(const ClpvRegion region, CLPV_TRIANGLES, __global uint* hidden, const uint cascade) {
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
