// SPDX-License-Identifier: MIT
// Projects a triangle along an axis of a cascade's grid and samples it, 8 x 8 samples per cell
// (blockers.cl, reflectors.cl).
//
// Coordinates: u and v along the two axes after the axis of projection, in samples; w along the
// axis, in cells. All three count from half a cell before the region's base. A sample within
// voxel_tolerance outside an edge is covered, so that triangles that share an edge leave no gap
// despite rounding.
#pragma once

#include "lanes.h"
#include "voxels/region.h"
#include "raster/texture.h"
#include "vec.h"

enum { CLPV_VOXEL_SAMPLES = 8 };
__constant const float voxel_tolerance = 1.0f / 256.0f;  // [samples]
// [samples] coordinates are clamped to it, so that floats hold them as integers.
__constant const float voxel_limit = 8e6f;

// A triangle projected along an axis.
typedef struct {
  float u[3], v[3];
  float w, w_u, w_v;         // at the first vertex; change per sample along u and v
  float nearest, farthest;   // smallest and largest w
  float e_u[3], e_v[3], tolerance[3];  // edge functions, positive inside, and the tolerance of each
  float inverse_area;
} ProjectedTriangle;

// Corners of a triangle, in samples along each axis.
typedef struct {
  float at[3][3];  // [axis][corner]
} GridCorners;

// Returns false for a triangle outside the region, extended by 3/4 of a cell on every side.
static inline bool find_grid_corners(const ClpvRegion* region,
                                     __global const ClpvVertex* const corner[3],
                                     GridCorners* corners) {
  const float per_sample = CLPV_VOXEL_SAMPLES / region->cell;
  bool within = true;
  for (int axis = 0; axis < 3; ++axis) {
    float* at = corners->at[axis];
    for (int i = 0; i < 3; ++i) {
      at[i] =
          (corner[i]->position[axis] - region->base[axis]) * per_sample + CLPV_VOXEL_SAMPLES / 2;
      at[i] = clamp(at[i], -voxel_limit, voxel_limit);
    }
    const int first = region->first[axis] + region->all.low[axis],
              end = region->first[axis] + region->all.high[axis] + 2;
    const float lowest = CLPV_VOXEL_SAMPLES * (first - 0.25f),
                highest = CLPV_VOXEL_SAMPLES * (end + 0.25f);
    within = within && fmax(at[0], fmax(at[1], at[2])) >= lowest &&
             fmin(at[0], fmin(at[1], at[2])) < highest;
  }
  return within;
}

// Returns false for a triangle that is seen edge-on or has no area.
static inline bool project_triangle(const GridCorners* corners, const uint axis,
                                    ProjectedTriangle* t) {
// With fma(), a triangle that is a diagonal line gets a small area instead of 0.
#pragma OPENCL FP_CONTRACT OFF
  float w[3];
  for (int i = 0; i < 3; ++i) {
    t->u[i] = corners->at[(axis + 1) % 3][i];
    t->v[i] = corners->at[(axis + 2) % 3][i];
    w[i] = corners->at[axis][i] * (1.0f / CLPV_VOXEL_SAMPLES);
  }
  const float u1 = t->u[1] - t->u[0], v1 = t->v[1] - t->v[0], w1 = w[1] - w[0];
  const float u2 = t->u[2] - t->u[0], v2 = t->v[2] - t->v[0], w2 = w[2] - w[0];
  const float area = u1 * v2 - u2 * v1;
  t->inverse_area = 1.0f / area;
  t->w = w[0];
  t->w_u = (w1 * v2 - w2 * v1) * t->inverse_area;
  t->w_v = (w2 * u1 - w1 * u2) * t->inverse_area;
  t->nearest = fmin(w[0], fmin(w[1], w[2]));
  t->farthest = fmax(w[0], fmax(w[1], w[2]));
  const float side = area < 0.0f ? -1.0f : 1.0f;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    t->e_u[i] = side * (t->v[i] - t->v[j]);
    t->e_v[i] = side * (t->u[j] - t->u[i]);
    t->tolerance[i] = voxel_tolerance * (fabs(t->e_u[i]) + fabs(t->e_v[i]));
  }
  return fabs(area) > 0.0f && fabs(t->w_u) <= voxel_limit && fabs(t->w_v) <= voxel_limit;
}

// First and last sample between three coordinates, within cells `first` to `last`, counted from the
// base.
static inline int2 voxel_range(const int first, const int last, const float a, const float b,
                               const float c) {
  const float from = ceil(fmin(a, fmin(b, c)) - 0.5f - voxel_tolerance);
  const float to = floor(fmax(a, fmax(b, c)) - 0.5f + voxel_tolerance);
  return (int2)((int)fmax(from, (float)(CLPV_VOXEL_SAMPLES * first)),
                (int)fmin(to, (float)(CLPV_VOXEL_SAMPLES * (last + 1) - 1)));
}

// First and last cell of the region along an axis, counted from the base.
static inline int2 cells_along(const ClpvRegion* region, const uint axis) {
  return of_axis(region->first, axis) +
         (int2)(of_axis(region->all.low, axis), of_axis(region->all.high, axis));
}

// Mask of the points (u, v) inside edge i.
static inline intW inside_edge(const ProjectedTriangle* t, const int i, const realW u,
                               const float v) {
  return t->e_u[i] * (u - t->u[i]) + t->e_v[i] * (v - t->v[i]) >= -t->tolerance[i];
}

// Mask of the W samples from (u, v) on along a row that the triangle covers.
CLPV_INLINE intW voxel_covered(const ProjectedTriangle* t, const float u, const float v) {
  const realW at = u + 0.5f + to_realW(lane_numbers());
  const float row = v + 0.5f;
  return inside_edge(t, 0, at, row) & inside_edge(t, 1, at, row) & inside_edge(t, 2, at, row);
}

// Depth w of the triangle's plane at those samples, clamped to the range of its vertices.
CLPV_INLINE realW voxel_depth(const ProjectedTriangle* t, const float u, const float v) {
  const realW at = u + 0.5f + to_realW(lane_numbers());
  const realW w = t->w + t->w_u * (at - t->u[0]) + t->w_v * (v + 0.5f - t->v[0]);
  const realW nearest = (realW)(t->nearest), farthest = (realW)(t->farthest);
  const realW not_before = w > nearest ? w : nearest;
  return not_before < farthest ? not_before : farthest;
}

// Weights of W samples, clamped to the triangle.
static inline Vec voxel_weights(const ProjectedTriangle* t, const realW u, const realW v) {
  const realW from = u - t->u[0], row = v - t->v[0];
  realW w1 = (from * (t->v[2] - t->v[0]) - row * (t->u[2] - t->u[0])) * t->inverse_area;
  realW w2 = (row * (t->u[1] - t->u[0]) - from * (t->v[1] - t->v[0])) * t->inverse_area;
  w1 = w1 > ZERO ? w1 : ZERO;
  w1 = w1 < ONE ? w1 : ONE;
  w2 = w2 > ZERO ? w2 : ZERO;
  w2 = w2 < ONE - w1 ? w2 : ONE - w1;
  return (Vec){ONE - w1 - w2, w1, w2};
}

// Mask of those samples where the alpha of a masked material reaches its cutoff: no hole.
CLPV_INLINE intW voxel_solid(const ProjectedTriangle* t, __global const ClpvVertex* const corner[3],
                             __global const ClpvMaterial* material, __global const float4* textures,
                             __global const uint* texels, const float u, const float v) {
  const Vec w = voxel_weights(t, u + 0.5f + to_realW(lane_numbers()), (realW)(v + 0.5f));
  const Uv uv = {uv_at(w, corner, 0), uv_at(w, corner, 1)};
  const uintW finest = (uintW)(material->texture * CLPV_TEXTURE_LEVELS);
  const realW alpha = material->base_colour[3] * colour_at(w, corner, 3) *
                       sample_alpha(textures, texels, finest, uv);
  return alpha >= material->alpha_cutoff;
}
