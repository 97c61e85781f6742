// SPDX-License-Identifier: MIT
// Computes the visibility of cell centres: for sample points between the centres of a cascade's
// cells, which of the eight centres about them a triangle occludes (docs/method.md, 'Gathering').
//
// Eight neighbouring centres are the corners of a cube of edge s. It holds 4 x 4 x 4 points, the
// centres of cubes of edge s / 4. The segment from centre c to point x crosses triangle (v0, v1,
// v2) if
//
//   n . (x - c) >= n . (v0 - c)             x is behind the plane, n its normal on the side away
//                                           from c
//   det(v_i - c, v_j - c, x - c) >= -e      for the edges (0, 1), (1, 2), (2, 0): x is inside the
//                                           pyramid with apex c
//
// with the determinants times the sign of n . (v0 - c). The tolerance e is edge_tolerance times the
// edge's L1 length, so that triangles that share an edge leave no gap. A triangle whose plane
// contains c does not occlude c. All four are linear functions of x.
//
// In:   triangles of the scene in `clusters` (region.h); region: the cubes to test. Masked
//       materials do not occlude.
// Out:  occluded  a byte per point: bit 0 to 7 for the centre offset by (bit & 1, bit >> 1 & 1, bit
//                 >> 2); 64 bytes per cube, points along x first, cubes numbered by their lowest
//                 cell
//       cascade   number of the cascade whose bytes to write
// A work-item tests a triangle. Bits are set by atomic_or: results do not depend on the order of
// triangles. Coordinates are in cells, from the lowest centre of a cube. From the host: CLPV_GRID.
#include "voxels/occlusion_tests.h"
#include "voxels/region.h"

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
static inline void occlude_cube(const float3 v0, const float3 v1, const float3 v2,
                                const float3 normal, __global volatile uint* points) {
#pragma unroll 1
  for (int first = 0; first < CLPV_CENTRES; first += W) {
    OcclusionTests tests;
    uint candidates[CLPV_LAYERS];
    set_up_tests(v0, v1, v2, normal, first, &tests, candidates);
#pragma unroll
    for (int layer = 0; layer < CLPV_LAYERS; ++layer) {
      if (candidates[layer] == 0) continue;
      const float z = first_point + 0.25f * (float)layer;
#pragma unroll 1
      for (int row = 0; row < 4; row += CLPV_ROWS)
        set_bits(points + 4 * layer + row,
                 find_occluded(&tests, first, candidates[layer], 0.25f * (float)row, z));
    }
  }
}

// Off the grid [cells]: a centre on a wall, as at round coordinates, would see both sides.
__constant const float3 off_grid = (float3)(2.0e-3f, 3.3e-3f, 4.7e-3f);

// Position of a vertex in cells, from the centre of the cell at the region's base.
static inline float3 to_cells(const ClpvRegion* region, __global const ClpvVertex* vertex) {
  const float3 position = (float3)(vertex->position[0], vertex->position[1], vertex->position[2]);
  const float3 base = (float3)(region->base[0], region->base[1], region->base[2]);
  return clamp((position - base) / region->cell - 0.5f - off_grid, -coordinate_limit,
               coordinate_limit);
}

__kernel void occlude_cells(const ClpvRegion region, __global const uint* clusters,
                            const uint first_cluster, const uint cluster_count,
                            const uint triangle_count, __global const ClpvVertex* vertices,
                            __global const ClpvTriangle* triangles,
                            __global const ClpvMaterial* materials, __global uint* occluded,
                            const uint cascade) {
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
  const float half_extent = 0.5f * l1_norm(normal);  // half a cube along it, times its length
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        const float3 cube = convert_float3((int3)(x, y, z) + first);
        if (fabs(dot(normal, cube + 0.5f - v0)) > half_extent || !in_region(&region, x, y, z))
          continue;
        occlude_cube(v0 - cube, v1 - cube, v2 - cube, normal,
                     occluded +
                         16 * (((size_t)cascade * CLPV_GRID + z) * CLPV_GRID + y) * CLPV_GRID +
                         16 * x);
      }
    }
  }
}
