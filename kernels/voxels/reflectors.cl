// SPDX-License-Identifier: MIT
// Voxelises albedo per face direction: for each light cell and each of its six faces, sums the
// coverage and the albedo of the triangles that count towards it.
//
//   share of axis a = |n_a| / (|n_x| + |n_y| + |n_z|),   n the triangle's normal (docs/method.md,
//                                                                                     'More
//                                                                                     bounces')
//
// A triangle counts towards the three faces nearest to n, and its back towards the three opposite
// ones. With CLPV_WHITE albedo is not summed, and backs count only where the material is
// double-sided. As virtual point lights do (inject/find_cells.cl), faces emit and receive off the
// surface, in cells whose centre is in front of it; along u and v, this offset is rounded to whole
// samples.
//
// Each axis is a raster of 8 x 8 samples per face (voxelize_triangle.h). Albedo is looked up once
// per row of samples, at the centre of the covered ones. Sums are integers, by atomic_add and
// atomic_or: results do not depend on the order of triangles.
//
// In:   triangles of the scene in `clusters` (region.h); region: the cells to voxelise; textures,
//       texels (texture.h)
// Out:  faces  CLPV_CELL_FACES x CLPV_FACE_WORDS uint32 words per cell (shared/reflectors.h),
//              zeroed before
// A work-item voxelises a triangle. From the host: CLPV_GRID, CLPV_MASKED, CLPV_TEXTURED,
// CLPV_COLOURED, CLPV_WHITE.
#include "shared/reflectors.h"
#include "voxels/face_samples.h"

// Sum over lanes of count times share, in fixed point; shares are clamped to [0, 1].
static inline uint fixed_sum(const realW count, const realW share) {
  const realW positive = share > ZERO ? share : ZERO;
  const uintW each = to_uintW_rte(CLPV_ALBEDO_UNIT * count * (positive < ONE ? positive : ONE));
  return sum_lanes_uint(each);
}

// Adds the samples of cell k in column i and row j to its face. `weight`: the triangle's share of
// the axis.
CLPV_INLINE void add_face(const ProjectedTriangle* t, const TriangleSurface* surface,
                          const FaceSamples* samples, const int i, const int j, const int k,
                          const float weight, __global volatile uint* face) {
  float count[CLPV_VOXEL_SAMPLES], middle[CLPV_VOXEL_SAMPLES];
  uint words[2] = {0, 0}, total = 0;
  for (int row = 0; row < CLPV_VOXEL_SAMPLES; ++row) {
    uint bits = 0, columns = 0;
    for (int vector = 0; vector < CLPV_ROW_VECTORS; ++vector) {
      const intW here = samples->covered[row][vector] & (samples->cell[row][vector] == k);
      bits |= lane_bits(here) << (vector * W);
      columns += sum_lanes_uint(as_uintW(all_bits(here) & (vector * W + lane_numbers())));
    }
    const uint of_row = popcount(bits);
    words[row / 4] |= bits << (8 * (row % 4));
    total += of_row;
    count[row] = (float)of_row;
    middle[row] = of_row > 0 ? (float)columns / (float)of_row : 0.0f;
  }
  if (total == 0) return;
  uint red = 0, green = 0, blue = 0, shares = 0;
  for (int row = 0; row < CLPV_VOXEL_SAMPLES; row += W) {
    const realW counts = load_lanes(count + row);
    shares += fixed_sum(weight * counts, (realW)(1.0f));
    if (CLPV_WHITE) continue;
    Vec albedo;
    find_albedo(t, surface, (float)(CLPV_VOXEL_SAMPLES * i) + 0.5f + load_lanes(middle + row),
                (float)(CLPV_VOXEL_SAMPLES * j + row) + 0.5f + to_realW(lane_numbers()),
                counts > ONE ? counts : ONE, &albedo);
    red += fixed_sum(weight * counts, albedo.x);
    green += fixed_sum(weight * counts, albedo.y);
    blue += fixed_sum(weight * counts, albedo.z);
  }
  if (words[0] != 0) atomic_or(face, words[0]);
  if (words[1] != 0) atomic_or(face + 1, words[1]);
  atomic_add(face + CLPV_FACE_SAMPLES, total);
  atomic_add(face + CLPV_FACE_SHARE, shares);
  if (CLPV_WHITE) return;
  atomic_add(face + CLPV_FACE_ALBEDO, red);
  atomic_add(face + CLPV_FACE_ALBEDO + 1, green);
  atomic_add(face + CLPV_FACE_ALBEDO + 2, blue);
}

// Adds a triangle, projected along an axis and moved to where it emits and receives, to the faces
// of one `direction`: 0 towards larger numbers, 1 towards smaller ones.
CLPV_INLINE void add_triangle(const ClpvRegion* region, const ProjectedTriangle* t,
                              const TriangleSurface* surface, const uint axis, const uint direction,
                              const float weight, __global volatile uint* faces) {
  const int2 cells = cells_along(region, axis), across = cells_along(region, (axis + 1) % 3),
             above = cells_along(region, (axis + 2) % 3);
  if (t->farthest < (float)cells.x || t->nearest >= (float)(cells.y + 1)) return;
  const int2 columns = voxel_range(across.x, across.y, t->u[0], t->u[1], t->u[2]);
  const int2 rows = voxel_range(above.x, above.y, t->v[0], t->v[1], t->v[2]);
  if (columns.x > columns.y) return;
  for (int j = rows.x / CLPV_VOXEL_SAMPLES; rows.x <= rows.y && j <= rows.y / CLPV_VOXEL_SAMPLES;
       ++j) {
    for (int i = columns.x / CLPV_VOXEL_SAMPLES; i <= columns.y / CLPV_VOXEL_SAMPLES; ++i) {
      FaceSamples samples;
      find_face_samples(t, surface, i, j, rows, cells, &samples);
      for (int k = samples.first; k <= samples.last; ++k) {
        const uint cell = find_region_cell(region, axis, i, j, k, CLPV_GRID);
        if (cell == no_cell) continue;
        const uint face = cell * CLPV_CELL_FACES + 2u * axis + direction;
        add_face(t, surface, &samples, i, j, k, weight, faces + (size_t)face * CLPV_FACE_WORDS);
      }
    }
  }
}

// Moves a triangle `by` cells, and from cells about corners, which voxelize_triangle.h counts, to
// light cells.
static inline ProjectedTriangle offset_triangle(const ProjectedTriangle* from, const float3 by) {
  ProjectedTriangle t = *from;
  const float u = rint(CLPV_VOXEL_SAMPLES * by.x) - CLPV_VOXEL_SAMPLES / 2;
  const float v = rint(CLPV_VOXEL_SAMPLES * by.y) - CLPV_VOXEL_SAMPLES / 2;
  const float w = by.z - 0.5f;
  for (int i = 0; i < 3; ++i) {
    t.u[i] += u;
    t.v[i] += v;
  }
  t.w += w;
  t.nearest += w;
  t.farthest += w;
  return t;
}

__kernel void voxelize_reflectors(const ClpvRegion region, __global const uint* clusters,
                                  const uint first_cluster, const uint cluster_count,
                                  const uint triangle_count, __global const ClpvVertex* vertices,
                                  __global const ClpvTriangle* triangles,
                                  __global const ClpvMaterial* materials,
                                  __global const float4* textures, __global const uint* texels,
                                  __global uint* faces) {
  const uint number = triangle_number(clusters, first_cluster, cluster_count, triangle_count);
  if (number >= triangle_count) return;
  const ClpvTriangle triangle = triangles[number];
  const TriangleSurface surface = {{vertices + triangle.vertex[0], vertices + triangle.vertex[1],
                                    vertices + triangle.vertex[2]},
                                   materials + triangle.material,
                                   textures,
                                   texels};
  GridCorners corners;
  if (!find_grid_corners(&region, surface.corner, &corners)) return;
  for (uint axis = 0; axis < 3; ++axis) {
    ProjectedTriangle t;
    if (!project_triangle(&corners, axis, &t)) continue;
    const float slope_u = CLPV_VOXEL_SAMPLES * t.w_u, slope_v = CLPV_VOXEL_SAMPLES * t.w_v;
    const float length = sqrt(1.0f + slope_u * slope_u + slope_v * slope_v);
    const float3 normal = (float3)(-slope_u, -slope_v, 1.0f) / length;  // along u, v and the axis
    const float weight = 1.0f / (fabs(normal.x) + fabs(normal.y) + normal.z);
    const float3 off = 0.5f / weight * normal;
    const ProjectedTriangle up = offset_triangle(&t, off), down = offset_triangle(&t, -off);
    const bool both = !CLPV_WHITE || (surface.material->flags & CLPV_MATERIAL_DOUBLE_SIDED) != 0;
    if (both || t.inverse_area > 0.0f)
      add_triangle(&region, &up, &surface, axis, 0, weight, faces);
    if (both || t.inverse_area < 0.0f)
      add_triangle(&region, &down, &surface, axis, 1, weight, faces);
  }
}
