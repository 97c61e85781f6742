// SPDX-License-Identifier: MIT
// What a scene's own triangles reflect: for each light cell and each way along an axis, the area of those in it that face
// that way, in faces of the cell, and their albedo (docs/method.md, 'More bounces').
//
// A triangle of normal n stands for areas facing the three axes it is nearest to, in the shares
// |n_a| / (|n_x| + |n_y| + |n_z|): they reflect as much as it does, and about n on the whole. Its other side does the same
// about -n. As virtual point lights do, a side lights and is lit half a cell off the surface along its normal; across an axis
// that is a whole number of samples.
//
// Each axis is a raster: lines along it through 8 x 8 samples of each cell's face (voxelize_triangle.h). A triangle adds to the
// cell and side that a line meets it in, once for each of its two sides; integers, by atomic_add and atomic_or: the order of
// triangles does not matter. A side's colour is looked up a row of samples at a time, in the middle of those covered.
//
// Out: `sides`, zeroed before; CLPV_SIDES x CLPV_SIDE_WORDS words a cell (shared/reflectors.h).
#include "voxelize_triangle.h"
#include "shared/reflectors.h"

#ifndef CLPV_TEXTURED
#define CLPV_TEXTURED 1
#define CLPV_COLOURED 1
#endif

#define CLPV_REFLECT_SCENE                                                                   \
  __global const ClpvVertex *const corner[3], __global const ClpvMaterial *material,         \
      __global const float4 *textures, __global const uint *texels
#define CLPV_PASS_SCENE corner, material, textures, texels

// The samples that a triangle covers in a cell's face, row by row, and how far along the axis: the cell's number.
typedef struct {
  int8 covered[CLPV_BLOCK_SAMPLES], cell[CLPV_BLOCK_SAMPLES];
  int first, last;  // cells
} Square;

static inline int clpv_least(const int8 a) {
  const int4 four = min(a.lo, a.hi);
  return min(min(four.x, four.y), min(four.z, four.w));
}
static inline int clpv_most(const int8 a) { return -clpv_least(-a); }

// Of the square in column i and row j, `rows` being those that the triangle may cover, `cells` those along the axis.
CLPV_INLINE void clpv_square(const BlockTriangle* t, CLPV_REFLECT_SCENE, const int i, const int j, const int2 rows,
                             const int2 cells, Square* square) {
  int8 lowest = (int8)(cells.y + 1), highest = (int8)(-1);
  for (int row = 0; row < CLPV_BLOCK_SAMPLES; ++row) {
    const int v = CLPV_BLOCK_SAMPLES * j + row;
    const float u = (float)(CLPV_BLOCK_SAMPLES * i);
    int8 covered = 0;
    if (v >= rows.x && v <= rows.y) covered = clpv_block_covered(t, u, (float)v);
#if CLPV_MASKED
    if ((material->flags & CLPV_MATERIAL_MASKED) != 0 && clpv_bits(covered) != 0)
      covered &= clpv_block_solid(t, CLPV_PASS_SCENE, u, (float)v);
#endif
    const int8 cell = convert_int8(clpv_block_depth(t, u, (float)v) + 1.0f) - 1;
    square->covered[row] = covered;
    square->cell[row] = cell;
    lowest = min(lowest, covered ? cell : (int8)(cells.y + 1));
    highest = max(highest, covered ? cell : (int8)(-1));
  }
  square->first = max(clpv_least(lowest), cells.x);
  square->last = min(clpv_most(highest), cells.y);
}

// The triangle's albedo in eight points (u, v), each the middle of a row of `across` samples.
CLPV_INLINE void clpv_albedo(const BlockTriangle* t, CLPV_REFLECT_SCENE, const float8 u, const float8 v, const float8 across,
                             Vec* albedo) {
  *albedo = vec_load(material->base_colour);
#if CLPV_TEXTURED || CLPV_COLOURED
  const BlockWeights w = clpv_block_weights(t, u, v);
#endif
#if CLPV_COLOURED
  *albedo = vec_product(*albedo, vec(CLPV_BLEND(w, corner, colour[0]), CLPV_BLEND(w, corner, colour[1]),
                                     CLPV_BLEND(w, corner, colour[2])));
#endif
#if CLPV_TEXTURED
  const float u1 = corner[1]->uv[0] - corner[0]->uv[0], v1 = corner[1]->uv[1] - corner[0]->uv[1];
  const float u2 = corner[2]->uv[0] - corner[0]->uv[0], v2 = corner[2]->uv[1] - corner[0]->uv[1];
  const float right1 = (t->v[2] - t->v[0]) * t->inverse_area, right2 = (t->v[0] - t->v[1]) * t->inverse_area;
  const float below1 = (t->u[0] - t->u[2]) * t->inverse_area, below2 = (t->u[1] - t->u[0]) * t->inverse_area;
  const Uv at = {CLPV_BLEND(w, corner, uv[0]), CLPV_BLEND(w, corner, uv[1])};
  const Uv right = {across * (right1 * u1 + right2 * u2), across * (right1 * v1 + right2 * v2)};
  const Uv below = {(float8)(below1 * u1 + below2 * u2), (float8)(below1 * v1 + below2 * v2)};
  Vec factor;
  clpv_trilinear(textures, texels, (uint8)(material->texture), at, right, below, &factor);
  *albedo = vec_product(*albedo, factor);
#endif
}

// A sum over lanes, of shares in [0, 1] of numbers of samples.
static inline uint clpv_total(const float8 count, const float8 share) {
  const float8 none = (float8)(0.0f), all = (float8)(1.0f);
  const float8 least = share > none ? share : none;
  const uint8 each = convert_uint8_rte(CLPV_REFLECT_UNIT * count * (least < all ? least : all));
  const uint4 four = each.lo + each.hi;
  return four.x + four.y + four.z + four.w;
}

// Adds what a triangle covers of a cell's face. `weight`: area that a covered sample stands for, in samples.
CLPV_INLINE void clpv_add_side(const BlockTriangle* t, CLPV_REFLECT_SCENE, const Square* square, const int i, const int j,
                               const int k, const float weight, __global volatile uint* side) {
  float count[CLPV_BLOCK_SAMPLES], middle[CLPV_BLOCK_SAMPLES];
  uint words[2] = {0, 0}, samples = 0;
  for (int row = 0; row < CLPV_BLOCK_SAMPLES; ++row) {
    const int8 here = square->covered[row] & (square->cell[row] == k);
    const uint bits = clpv_bits(here);
    const int8 column = here & (int8)(0, 1, 2, 3, 4, 5, 6, 7);
    const int4 four = column.lo + column.hi;
    const uint of_row = popcount(bits);
    words[row / 4] |= bits << (8 * (row % 4));
    samples += of_row;
    count[row] = (float)of_row;
    middle[row] = of_row > 0 ? (float)(four.x + four.y + four.z + four.w) / (float)of_row : 0.0f;
  }
  if (samples == 0) return;
  const float8 counts = vload8(0, count), one = (float8)(1.0f);
  Vec albedo;
  clpv_albedo(t, CLPV_PASS_SCENE, (float)(CLPV_BLOCK_SAMPLES * i) + 0.5f + vload8(0, middle),
              (float)(CLPV_BLOCK_SAMPLES * j) + 0.5f + CLPV_EIGHT, counts > one ? counts : one, &albedo);
  if (words[0] != 0) atomic_or(side, words[0]);
  if (words[1] != 0) atomic_or(side + 1, words[1]);
  atomic_add(side + CLPV_SIDE_COUNT, samples);
  atomic_add(side + CLPV_SIDE_COLOUR, clpv_total(weight * counts, albedo.x));
  atomic_add(side + CLPV_SIDE_COLOUR + 1, clpv_total(weight * counts, albedo.y));
  atomic_add(side + CLPV_SIDE_COLOUR + 2, clpv_total(weight * counts, albedo.z));
}

// The words of a side of cell (i, j, k) counted along u, v and the axis from the base, or none where it is not made anew.
#define CLPV_NO_WORD 0xffffffffu
static inline uint clpv_side_word(const ClpvRegion* region, const uint axis, const int i, const int j, const int k,
                                  const uint side) {
  int at[3];
  at[(axis + 1) % 3] = i;
  at[(axis + 2) % 3] = j;
  at[axis] = k;
  const int x = at[0] - region->first[0], y = at[1] - region->first[1], z = at[2] - region->first[2];
  if (!clpv_in_region(region, x, y, z)) return CLPV_NO_WORD;
  return (uint)((z * CLPV_GRID + y) * CLPV_GRID + x) * (CLPV_SIDES * CLPV_SIDE_WORDS) + (2 * axis + side) * CLPV_SIDE_WORDS;
}

// A triangle seen along an axis, where its side lights and is lit; the base's first light cell at 0.
CLPV_INLINE void clpv_add_triangle(const ClpvRegion* region, const BlockTriangle* t, CLPV_REFLECT_SCENE, const uint axis,
                                   const uint side, const float weight, __global volatile uint* sides) {
  const int2 cells = clpv_cells_along(region, axis), across = clpv_cells_along(region, (axis + 1) % 3),
             above = clpv_cells_along(region, (axis + 2) % 3);
  if (t->farthest < (float)cells.x || t->nearest >= (float)(cells.y + 1)) return;
  const int2 columns = clpv_block_range(across.x, across.y, t->u[0], t->u[1], t->u[2]);
  const int2 rows = clpv_block_range(above.x, above.y, t->v[0], t->v[1], t->v[2]);
  if (columns.x > columns.y) return;
  for (int j = rows.x / CLPV_BLOCK_SAMPLES; rows.x <= rows.y && j <= rows.y / CLPV_BLOCK_SAMPLES; ++j) {
    for (int i = columns.x / CLPV_BLOCK_SAMPLES; i <= columns.y / CLPV_BLOCK_SAMPLES; ++i) {
      Square square;
      clpv_square(t, CLPV_PASS_SCENE, i, j, rows, cells, &square);
      for (int k = square.first; k <= square.last; ++k) {
        const uint word = clpv_side_word(region, axis, i, j, k, side);
        if (word != CLPV_NO_WORD) clpv_add_side(t, CLPV_PASS_SCENE, &square, i, j, k, weight, sides + word);
      }
    }
  }
}

// voxelize_triangle.h counts from half a cell before the base: moved to where the side that faces up the axis, or down it, is lit.
static inline BlockTriangle clpv_lit_at(const BlockTriangle* from, const float3 normal) {
  BlockTriangle t = *from;
  const float u = rint(0.5f * CLPV_BLOCK_SAMPLES * normal.x) - CLPV_BLOCK_SAMPLES / 2;
  const float v = rint(0.5f * CLPV_BLOCK_SAMPLES * normal.y) - CLPV_BLOCK_SAMPLES / 2;
  const float w = 0.5f * normal.z - 0.5f;
  for (int i = 0; i < 3; ++i) {
    t.u[i] += u;
    t.v[i] += v;
  }
  t.w += w;
  t.nearest += w;
  t.farthest += w;
  return t;
}

// A work-item is a triangle.
__kernel void voxelize_reflectors(const ClpvRegion region, CLPV_TRIANGLES, __global const float4* textures,
                                __global const uint* texels, __global uint* sides) {
  const uint number = CLPV_TRIANGLE_NUMBER;
  if (number >= triangle_count) return;
  const ClpvTriangle triangle = triangles[number];
  __global const ClpvVertex* const corner[3] = {vertices + triangle.vertex[0], vertices + triangle.vertex[1],
                                                vertices + triangle.vertex[2]};
  __global const ClpvMaterial* material = materials + triangle.material;
  BlockCorners corners;
  if (!clpv_block_corners(&region, corner, &corners)) return;
  for (uint axis = 0; axis < 3; ++axis) {
    BlockTriangle t;
    if (!clpv_block_triangle(&corners, axis, &t)) continue;
    const float slope_u = CLPV_BLOCK_SAMPLES * t.w_u, slope_v = CLPV_BLOCK_SAMPLES * t.w_v;
    const float length = sqrt(1.0f + slope_u * slope_u + slope_v * slope_v);
    const float3 normal = (float3)(-slope_u, -slope_v, 1.0f) / length;  // along u, v and the axis
    const float weight = 1.0f / (fabs(normal.x) + fabs(normal.y) + normal.z);
    const BlockTriangle up = clpv_lit_at(&t, normal), down = clpv_lit_at(&t, -normal);
    clpv_add_triangle(&region, &up, CLPV_PASS_SCENE, axis, 0, weight, sides);
    clpv_add_triangle(&region, &down, CLPV_PASS_SCENE, axis, 1, weight, sides);
  }
}
