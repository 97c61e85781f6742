// SPDX-License-Identifier: MIT
// Samples of a cell's face that a triangle covers, and its albedo there (reflectors.cl).
#pragma once

#include "voxels/voxelize_triangle.h"

// Corners and material of a triangle.
typedef struct {
  __global const ClpvVertex* corner[3];
  __global const ClpvMaterial* material;
  __global const float4* textures;
  __global const uint* texels;
} TriangleSurface;

// Samples of one cell's face that a triangle covers, row by row, with the cell number along the
// axis at each.
enum { CLPV_ROW_VECTORS = CLPV_VOXEL_SAMPLES / W };
typedef struct {
  intW covered[CLPV_VOXEL_SAMPLES][CLPV_ROW_VECTORS], cell[CLPV_VOXEL_SAMPLES][CLPV_ROW_VECTORS];
  int first, last;  // smallest and largest cell number
} FaceSamples;

// Finds the covered samples of the face in column i and row j. `rows`: range of rows of the
// triangle; `cells`: range of cells along the axis.
CLPV_INLINE void find_face_samples(const ProjectedTriangle* t, const TriangleSurface* surface,
                                   const int i, const int j, const int2 rows, const int2 cells,
                                   FaceSamples* samples) {
  intW lowest = (intW)(cells.y + 1), highest = (intW)(-1);
  for (int n = 0; n < CLPV_VOXEL_SAMPLES * CLPV_ROW_VECTORS; ++n) {
    const int row = n / CLPV_ROW_VECTORS, vector = n % CLPV_ROW_VECTORS,
              v = CLPV_VOXEL_SAMPLES * j + row;
    const float u = (float)(CLPV_VOXEL_SAMPLES * i + vector * W);
    intW covered = 0;
    if (v >= rows.x && v <= rows.y) covered = voxel_covered(t, u, (float)v);
    if (CLPV_MASKED && (surface->material->flags & CLPV_MATERIAL_MASKED) != 0 &&
        lane_bits(covered) != 0)
      covered &= voxel_solid(t, surface->corner, surface->material, surface->textures,
                             surface->texels, u, (float)v);
    const intW cell = to_intW(voxel_depth(t, u, (float)v) + 1.0f) - 1;
    samples->covered[row][vector] = covered;
    samples->cell[row][vector] = cell;
    lowest = min(lowest, covered ? cell : (intW)(cells.y + 1));
    highest = max(highest, covered ? cell : (intW)(-1));
  }
  samples->first = max(min_lane_int(lowest), cells.x);
  samples->last = min(max_lane_int(highest), cells.y);
}

// Albedo of the triangle at W points (u, v), each the centre of a row of `across` samples.
CLPV_INLINE void find_albedo(const ProjectedTriangle* t, const TriangleSurface* surface,
                             const realW u, const realW v, const realW across, Vec* albedo) {
  __global const ClpvVertex* const* corner = surface->corner;
  *albedo = vec_load(surface->material->base_colour);
  const Vec w = voxel_weights(t, u, v);
  if (CLPV_COLOURED)
    *albedo =
        vec_product(*albedo, vec(colour_at(w, corner, 0), colour_at(w, corner, 1),
                                 colour_at(w, corner, 2)));
  if (!CLPV_TEXTURED) return;
  const float u1 = corner[1]->uv[0] - corner[0]->uv[0], v1 = corner[1]->uv[1] - corner[0]->uv[1];
  const float u2 = corner[2]->uv[0] - corner[0]->uv[0], v2 = corner[2]->uv[1] - corner[0]->uv[1];
  const float right1 = (t->v[2] - t->v[0]) * t->inverse_area,
              right2 = (t->v[0] - t->v[1]) * t->inverse_area;
  const float below1 = (t->u[0] - t->u[2]) * t->inverse_area,
              below2 = (t->u[1] - t->u[0]) * t->inverse_area;
  const Uv at = {uv_at(w, corner, 0), uv_at(w, corner, 1)};
  const Uv right = {across * (right1 * u1 + right2 * u2), across * (right1 * v1 + right2 * v2)};
  const Uv below = {(realW)(below1 * u1 + below2 * u2), (realW)(below1 * v1 + below2 * v2)};
  Vec factor;
  sample_trilinear(surface->textures, surface->texels, (uintW)(surface->material->texture), at,
                   right, below, &factor);
  *albedo = vec_product(*albedo, factor);
}
