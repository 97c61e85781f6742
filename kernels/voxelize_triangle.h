// SPDX-License-Identifier: MIT
// A triangle seen along an axis of a cascade's grid, 8 x 8 samples to a cell's square: what blockers.cl and reflectors.cl go through.
//
// Coordinates: u, v along the axes after the one it is seen along, in samples from half a cell before the region's base on; w
// along it in cells from there. A sample counts as covered up to CLPV_BLOCK_SEAM of a sample outside an edge, so that triangles
// that share one leave no gap, whatever rounding does.
#ifndef CLPV_VOXELIZE_TRIANGLE_H
#define CLPV_VOXELIZE_TRIANGLE_H

#include "lanes.h"
#include "region.h"
#include "texture.h"
#include "vec.h"

#define CLPV_BLOCK_SAMPLES 8
#define CLPV_BLOCK_SEAM (1.0f / 256.0f)
// Where coordinates are kept, in samples, so that whole numbers hold them: a cascade has 513 x 8 at most, as far from its base
// as five more.
#define CLPV_BLOCK_FAR 8e6f

#ifndef CLPV_MASKED
#define CLPV_MASKED 1  // 0: no material has holes
#endif

// A triangle seen along an axis.
typedef struct {
  float u[3], v[3];
  float w, w_u, w_v;  // at the first vertex, and its change a sample along u and v
  float nearest, farthest;
  float e_u[3], e_v[3], seam[3];  // edges, positive inside, and how far outside still counts
  float inverse_area;
} BlockTriangle;

// Where a triangle's corners are, in samples along each axis.
typedef struct {
  float at[3][3];  // [axis][corner]
} BlockCorners;

// False for a triangle that lies beside the region, half a cell more on every side.
static inline bool clpv_block_corners(const ClpvRegion* region, __global const ClpvVertex* const corner[3],
                                      BlockCorners* corners) {
  const float per_sample = CLPV_BLOCK_SAMPLES / region->cell;
  bool within = true;
  for (int axis = 0; axis < 3; ++axis) {
    float* at = corners->at[axis];
    for (int i = 0; i < 3; ++i) {
      at[i] = (corner[i]->position[axis] - region->base[axis]) * per_sample + CLPV_BLOCK_SAMPLES / 2;
      at[i] = clamp(at[i], -CLPV_BLOCK_FAR, CLPV_BLOCK_FAR);
    }
    const int first = region->first[axis] + region->all.low[axis], end = region->first[axis] + region->all.high[axis] + 2;
    within = within && fmax(at[0], fmax(at[1], at[2])) >= (float)(CLPV_BLOCK_SAMPLES * first) &&
             fmin(at[0], fmin(at[1], at[2])) < (float)(CLPV_BLOCK_SAMPLES * end);
  }
  return within;
}

// False for one that is seen edge-on, or has no area at all.
static inline bool clpv_block_triangle(const BlockCorners* corners, const uint axis, BlockTriangle* t) {
  float w[3];
  for (int i = 0; i < 3; ++i) {
    t->u[i] = corners->at[(axis + 1) % 3][i];
    t->v[i] = corners->at[(axis + 2) % 3][i];
    w[i] = corners->at[axis][i] * (1.0f / CLPV_BLOCK_SAMPLES);
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
    t->seam[i] = CLPV_BLOCK_SEAM * (fabs(t->e_u[i]) + fabs(t->e_v[i]));
  }
  return fabs(area) > 0.0f && fabs(t->w_u) <= CLPV_BLOCK_FAR && fabs(t->w_v) <= CLPV_BLOCK_FAR;
}

// First and last sample between three coordinates, of those of cells `first` to `last`, counted from the base.
static inline int2 clpv_block_range(const int first, const int last, const float a, const float b, const float c) {
  const float from = ceil(fmin(a, fmin(b, c)) - 0.5f - CLPV_BLOCK_SEAM);
  const float to = floor(fmax(a, fmax(b, c)) - 0.5f + CLPV_BLOCK_SEAM);
  return (int2)((int)fmax(from, (float)(CLPV_BLOCK_SAMPLES * first)),
                (int)fmin(to, (float)(CLPV_BLOCK_SAMPLES * (last + 1) - 1)));
}

// The region's first and last cell along an axis, counted from the base.
static inline int2 clpv_cells_along(const ClpvRegion* region, const uint axis) {
  return clpv_of_axis(region->first, axis) +
         (int2)(clpv_of_axis(region->all.low, axis), clpv_of_axis(region->all.high, axis));
}

#define CLPV_EIGHT ((float8)(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f))

// Which of the eight samples from column `u` on of a row the triangle covers.
CLPV_INLINE int8 clpv_block_covered(const BlockTriangle* t, const float u, const float v) {
  const float8 at = u + 0.5f + CLPV_EIGHT;
  const float row = v + 0.5f;
#define CLPV_EDGE(i) (t->e_u[i] * (at - t->u[i]) + t->e_v[i] * (row - t->v[i]) >= -t->seam[i])
  return CLPV_EDGE(0) & CLPV_EDGE(1) & CLPV_EDGE(2);
#undef CLPV_EDGE
}

// Where along the axis its plane is there; between its vertices even where it is steep.
CLPV_INLINE float8 clpv_block_depth(const BlockTriangle* t, const float u, const float v) {
  const float8 at = u + 0.5f + CLPV_EIGHT;
  const float8 w = t->w + t->w_u * (at - t->u[0]) + t->w_v * (v + 0.5f - t->v[0]);
  const float8 nearest = (float8)(t->nearest), farthest = (float8)(t->farthest);
  const float8 not_before = w > nearest ? w : nearest;
  return not_before < farthest ? not_before : farthest;
}

// A point's weights of the second and the third corner; on the triangle, wherever the point is.
typedef struct {
  float8 w1, w2;
} BlockWeights;

static inline BlockWeights clpv_block_weights(const BlockTriangle* t, const float8 u, const float8 v) {
  const float8 from = u - t->u[0], row = v - t->v[0];
  const float8 none = (float8)(0.0f), all = (float8)(1.0f);
  float8 w1 = (from * (t->v[2] - t->v[0]) - row * (t->u[2] - t->u[0])) * t->inverse_area;
  float8 w2 = (row * (t->u[1] - t->u[0]) - from * (t->v[1] - t->v[0])) * t->inverse_area;
  w1 = w1 > none ? w1 : none;
  w1 = w1 < all ? w1 : all;
  w2 = w2 > none ? w2 : none;
  w2 = w2 < all - w1 ? w2 : all - w1;
  const BlockWeights weights = {w1, w2};
  return weights;
}

// A vertex's field between corners.
#define CLPV_BLEND(weights, corner, field)                                                          \
  ((1.0f - (weights).w1 - (weights).w2) * (corner)[0]->field + (weights).w1 * (corner)[1]->field + \
   (weights).w2 * (corner)[2]->field)

#if CLPV_MASKED
// Of samples that a triangle of a masked material covers, those where it is no hole.
CLPV_INLINE int8 clpv_block_solid(const BlockTriangle* t, __global const ClpvVertex* const corner[3],
                                  __global const ClpvMaterial* material, __global const float4* textures,
                                  __global const uint* texels, const float u, const float v) {
  const BlockWeights w = clpv_block_weights(t, u + 0.5f + CLPV_EIGHT, (float8)(v + 0.5f));
  const Uv uv = {CLPV_BLEND(w, corner, uv[0]), CLPV_BLEND(w, corner, uv[1])};
  const uint8 finest = (uint8)(material->texture * CLPV_TEXTURE_LEVELS);
  const float8 alpha = material->base_colour[3] * CLPV_BLEND(w, corner, colour[3]) *
                       clpv_bilinear_alpha(textures, texels, finest, uv);
  return alpha >= material->alpha_cutoff;
}
#endif

#endif
