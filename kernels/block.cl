// SPDX-License-Identifier: MIT
// What a scene's own triangles block: for each corner of a cascade's light cells and each axis, the share of the square
// of a cell's edge across that axis that triangles inside the corner's cell cover (docs/method.md, 'Blockers').
//
//   block_triangles   sets the bits of the samples that a triangle covers
//   block_shares      counts them into a geometry volume
//
// A corner's cell is the cube of edge s about it. Along axis a, lines through 8 x 8 samples of its square are met by a
// triangle inside the cube or not: 64 bits a corner and axis, two words, bit 8 row + column. Bits are set by atomic_or, so
// that the order of triangles does not matter: union, not sum.
//
// Coordinates: u, v along the axes after a, in samples from the outermost corner's square on; w along a in cells, whose
// whole part is the number of the corner. A sample counts as covered up to CLPV_BLOCK_SEAM of a sample outside an edge, so
// that triangles that share one leave no gap, whatever rounding does.
#include "lanes.h"
#include "shared/grid.h"
#include "texture.h"
#include "vec.h"

#define CLPV_BLOCK_SAMPLES 8
#define CLPV_BLOCK_SEAM (1.0f / 256.0f)
// Where coordinates are kept, in samples, so that whole numbers hold them: a cascade has 513 x 8 at most.
#define CLPV_BLOCK_FAR 1e6f

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

// Coordinates in samples of vertex `i` along an axis.
static inline float clpv_block_at(const ClpvGrid grid, __global const ClpvVertex* vertex, const uint axis) {
  const float at = (vertex->position[axis] - grid.origin[axis]) / grid.cell * CLPV_BLOCK_SAMPLES;
  return clamp(at + CLPV_BLOCK_SAMPLES / 2, -CLPV_BLOCK_FAR, CLPV_BLOCK_FAR);
}

// False for one that is seen edge-on, or has no area at all.
static inline bool clpv_block_triangle(const ClpvGrid grid, __global const ClpvVertex* const corner[3],
                                       const uint axis, BlockTriangle* t) {
  float w[3];
  for (int i = 0; i < 3; ++i) {
    t->u[i] = clpv_block_at(grid, corner[i], (axis + 1) % 3);
    t->v[i] = clpv_block_at(grid, corner[i], (axis + 2) % 3);
    w[i] = clpv_block_at(grid, corner[i], axis) * (1.0f / CLPV_BLOCK_SAMPLES);
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

// First and last sample between two coordinates, of those there are.
static inline int2 clpv_block_range(const float a, const float b, const float c) {
  const float first = ceil(fmin(a, fmin(b, c)) - 0.5f - CLPV_BLOCK_SEAM);
  const float last = floor(fmax(a, fmax(b, c)) - 0.5f + CLPV_BLOCK_SEAM);
  const float most = CLPV_BLOCK_SAMPLES * (CLPV_GRID + 1) - 1;
  return (int2)((int)fmax(first, 0.0f), (int)fmin(last, most));
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

#if CLPV_MASKED
// Of samples that a triangle of a masked material covers, those where it is no hole.
CLPV_INLINE int8 clpv_block_solid(const BlockTriangle* t, __global const ClpvVertex* const corner[3],
                                  __global const ClpvMaterial* material, __global const float4* textures,
                                  __global const uint* texels, const float u, const float v) {
  const float8 at = u + 0.5f + CLPV_EIGHT, from = at - t->u[0];
  const float row = v + 0.5f - t->v[0];
  const float8 none = (float8)(0.0f), all = (float8)(1.0f);
  float8 w1 = (from * (t->v[2] - t->v[0]) - row * (t->u[2] - t->u[0])) * t->inverse_area;
  float8 w2 = (row * (t->u[1] - t->u[0]) - from * (t->v[1] - t->v[0])) * t->inverse_area;
  w1 = w1 > none ? w1 : none;
  w1 = w1 < all ? w1 : all;
  w2 = w2 > none ? w2 : none;
  w2 = w2 < all - w1 ? w2 : all - w1;
  const float8 w0 = all - w1 - w2;
#define CLPV_BLEND(field) (w0 * corner[0]->field + w1 * corner[1]->field + w2 * corner[2]->field)
  const Uv uv = {CLPV_BLEND(uv[0]), CLPV_BLEND(uv[1])};
  const uint8 finest = (uint8)(material->texture * CLPV_TEXTURE_LEVELS);
  const float8 alpha = material->base_colour[3] * CLPV_BLEND(colour[3]) *
                       clpv_bilinear_alpha(textures, texels, finest, uv);
#undef CLPV_BLEND
  return alpha >= material->alpha_cutoff;
}
#endif

static inline uint clpv_block_bits(const int8 lanes) {
  const int8 bits = lanes & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
  const int4 four = bits.lo | bits.hi;
  return (uint)(four.x | four.y | four.z | four.w);
}

// The word of corner (i, j, k) counted along u, v and the axis.
static inline uint clpv_block_word(const uint axis, const int i, const int j, const int k) {
  int at[3];
  at[(axis + 1) % 3] = i;
  at[(axis + 2) % 3] = j;
  at[axis] = k;
  const int n = CLPV_GRID + 1;
  return (uint)((((int)axis * n + at[2]) * n + at[1]) * n + at[0]) * 2u;
}

// Sets a row's bits: one word where all covered samples lie in one cell, else one a cell.
CLPV_INLINE void clpv_block_row(__global volatile uint* masks, const uint axis, const int i, const int v,
                                const int8 covered, const float8 w) {
  const int8 cell = convert_int8(w + 1.0f) - 1;  // its floor, or less than 0 where that is
  const int8 lowest = covered ? cell : (int8)(CLPV_GRID + 1), highest = covered ? cell : (int8)(-1);
  const int4 low4 = min(lowest.lo, lowest.hi), high4 = max(highest.lo, highest.hi);
  const int first = max(min(min(low4.x, low4.y), min(low4.z, low4.w)), 0);
  const int last = min(max(max(high4.x, high4.y), max(high4.z, high4.w)), CLPV_GRID);
  const int row = v % CLPV_BLOCK_SAMPLES;
  for (int k = first; k <= last; ++k) {
    const uint bits = clpv_block_bits(covered & (cell == k));
    if (bits == 0) continue;
    const uint word = clpv_block_word(axis, i, v / CLPV_BLOCK_SAMPLES, k) + (uint)(row / 4);
    atomic_or(masks + word, bits << (8 * (row % 4)));
  }
}

// A work-item is a triangle; `first`: of those of the scene, the first of this launch.
__kernel void block_triangles(const ClpvGrid grid, const uint first, const uint count,
                              __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                              __global const ClpvMaterial* materials, __global const float4* textures,
                              __global const uint* texels, __global uint* masks) {
  if (get_global_id(0) >= count) return;
  const ClpvTriangle triangle = triangles[first + get_global_id(0)];
  __global const ClpvVertex* const corner[3] = {vertices + triangle.vertex[0], vertices + triangle.vertex[1],
                                                vertices + triangle.vertex[2]};
#if CLPV_MASKED
  __global const ClpvMaterial* material = materials + triangle.material;
  const bool masked = (material->flags & CLPV_MATERIAL_MASKED) != 0;
#endif
  for (uint axis = 0; axis < 3; ++axis) {
    BlockTriangle t;
    const bool has_area = clpv_block_triangle(grid, corner, axis, &t);
    if (!has_area || t.farthest < 0.0f || t.nearest >= (float)(CLPV_GRID + 1)) continue;
    const int2 columns = clpv_block_range(t.u[0], t.u[1], t.u[2]), rows = clpv_block_range(t.v[0], t.v[1], t.v[2]);
    if (columns.x > columns.y) continue;
    for (int v = rows.x; v <= rows.y; ++v) {
      for (int i = columns.x / CLPV_BLOCK_SAMPLES; i <= columns.y / CLPV_BLOCK_SAMPLES; ++i) {
        const float u = (float)(i * CLPV_BLOCK_SAMPLES);
        int8 covered = clpv_block_covered(&t, u, (float)v);
        if (clpv_block_bits(covered) == 0) continue;
#if CLPV_MASKED
        if (masked) covered &= clpv_block_solid(&t, corner, material, textures, texels, u, (float)v);
#endif
        clpv_block_row(masks, axis, i, v, covered, clpv_block_depth(&t, u, (float)v));
      }
    }
  }
}
