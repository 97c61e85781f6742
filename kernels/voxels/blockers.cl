// SPDX-License-Identifier: MIT
// Voxelises blockers: for each corner of the light cells and each axis, marks the part of a square
// that triangles cover.
//
//   B_a = share of the square s x s across a, about the corner, that triangles inside the cube s^3
//   about the corner cover
//
// (docs/method.md, 'Blockers'.) 8 x 8 lines along the axis sample the square. Bit 8 row + column is
// set if a triangle intersects the line inside the cube. Bits are set by atomic_or: overlapping
// triangles count once, and results do not depend on their order. blocked_areas.cl counts the bits.
//
// In:   triangles of the scene in `clusters` (region.h); region: the corners to voxelise; textures,
//       texels (texture.h)
// Out:  masks    CLPV_BLOCKER_WORDS uint32 words per corner (shared/blockers.h), cleared in the
//                region before
//       cascade  number of the cascade whose masks to write
// A work-item voxelises a triangle. The integer part of w (voxelize_triangle.h) is the number of
// the corner. From the host: CLPV_GRID, CLPV_MASKED, CLPV_ONLY_MASKED.
#include "voxels/voxelize_triangle.h"
#include "shared/blockers.h"

// Sets the bits of W samples from (u, v) on along a row, in one word per corner.
CLPV_INLINE void set_row(const ClpvRegion* region, __global volatile uint* masks, const uint axis,
                         const int u, const int v, const intW covered, const realW w) {
  const int2 cells = cells_along(region, axis);
  const intW cell = to_intW(w + 1.0f) - 1;  // floor(w); a negative number for w below 0
  const intW lowest = covered ? cell : (intW)(cells.y + 1), highest = covered ? cell : (intW)(-1);
  const int first = max(min_lane_int(lowest), cells.x), last = min(max_lane_int(highest), cells.y);
  const int row = v % CLPV_VOXEL_SAMPLES;
  for (int k = first; k <= last; ++k) {
    const uint bits = lane_bits(covered & (cell == k));
    if (bits == 0) continue;
    const uint number = find_region_cell(region, axis, u / CLPV_VOXEL_SAMPLES,
                                         v / CLPV_VOXEL_SAMPLES, k, CLPV_GRID + 1);
    if (number == no_cell) continue;
    atomic_or(masks + number * CLPV_BLOCKER_WORDS + 2u * axis + row / 4,
              bits << (8 * (row % 4) + u % CLPV_VOXEL_SAMPLES));
  }
}

__kernel void voxelize_blockers(const ClpvRegion region, __global const uint* clusters,
                                const uint first_cluster, const uint cluster_count,
                                const uint triangle_count, __global const ClpvVertex* vertices,
                                __global const ClpvTriangle* triangles,
                                __global const ClpvMaterial* materials,
                                __global const float4* textures, __global const uint* texels,
                                __global uint* masks, const uint cascade) {
  const uint number = triangle_number(clusters, first_cluster, cluster_count, triangle_count);
  if (number >= triangle_count) return;
  const ClpvTriangle triangle = triangles[number];
  __global uint* mine = masks + (size_t)cascade * CLPV_BLOCKER_MASKS;
  __global const ClpvVertex* const corner[3] = {
      vertices + triangle.vertex[0], vertices + triangle.vertex[1], vertices + triangle.vertex[2]};
  __global const ClpvMaterial* material = materials + triangle.material;
  const bool masked = CLPV_MASKED && (material->flags & CLPV_MATERIAL_MASKED) != 0;
  if (CLPV_ONLY_MASKED && !masked) return;
  GridCorners corners;
  if (!find_grid_corners(&region, corner, &corners)) return;
  int2 samples[3];  // range of samples along each axis that the triangle may cover
  for (int axis = 0; axis < 3; ++axis) {
    const float* at = corners.at[axis];
    const int2 cells = cells_along(&region, axis);
    samples[axis] = voxel_range(cells.x, cells.y, at[0], at[1], at[2]);
  }
  for (uint axis = 0; axis < 3; ++axis) {
    const int2 columns = samples[(axis + 1) % 3], rows = samples[(axis + 2) % 3];
    ProjectedTriangle t;
    if (columns.x > columns.y || rows.x > rows.y || !project_triangle(&corners, axis, &t)) continue;
    for (int v = rows.x; v <= rows.y; ++v) {
      for (int i = columns.x / W; i <= columns.y / W; ++i) {
        const float u = (float)(i * W);
        intW covered = voxel_covered(&t, u, (float)v);
        if (lane_bits(covered) == 0) continue;
        if (masked) covered &= voxel_solid(&t, corner, material, textures, texels, u, (float)v);
        set_row(&region, mine, axis, i * W, v, covered, voxel_depth(&t, u, (float)v));
      }
    }
  }
}
