// SPDX-License-Identifier: MIT
// Nearest triangle along a ray: a tree of bounding boxes with eight children per node
// (shared/tree.h).
//
// A ray tests the eight boxes of a node, or the eight triangles of a leaf, W at a time. Triangles:
// Moeller and Trumbore 1997, 'Fast, minimum storage ray-triangle intersection'. Both sides are hit;
// holes of masked materials are not. tree_lists.h and tree_stack.h walk through the tree.
#pragma once

#include "raster/scene_triangles.h"
#include "shared/tree.h"

typedef struct {
  __global const realW *nodes, *leaves;
} Tree;

enum {
  CLPV_TREE_VECTORS = CLPV_TREE_WIDTH / W,  // vectors in a row of a node or a leaf
};

// W rays and their nearest hits.
typedef struct {
  float from[3][W], along[3][W], inverse[3][W];  // [m]; unit; 1 / along
  uint near_row[3][W];  // row of a node that holds the nearer planes
  float distance[W];   // distance of the hit [m], or reach of the ray
  float u[W], v[W];  // weights of the second and third vertex
  uint triangle[W];
} Rays;

__constant const float box_margin = 1.000001f;  // covers the rounding of distances to planes

CLPV_INLINE void set_ray_axis(const int axis, const realW from, const realW along, Rays* rays) {
  const realW least = along < ZERO ? (realW)(-1e-20f) : (realW)(1e-20f);
  store_lanes(from, rays->from[axis]);
  store_lanes(along, rays->along[axis]);
  store_lanes(1.0f / (fabs(along) > fabs(least) ? along : least), rays->inverse[axis]);
  store_lanes(along < ZERO ? (uintW)(CLPV_TREE_UPPER + axis) : (uintW)(CLPV_TREE_LOWER + axis),
              rays->near_row[axis]);
}

// Initialises W rays without hits. A ray of reach 0 never gets one.
CLPV_INLINE void set_rays(const Vec from, const Vec along, const realW reach, Rays* rays) {
  set_ray_axis(0, from.x, along.x, rays);
  set_ray_axis(1, from.y, along.y, rays);
  set_ray_axis(2, from.z, along.z, rays);
  store_lanes(reach, rays->distance);
  store_lanes(ZERO, rays->u);
  store_lanes(ZERO, rays->v);
  store_lanes((uintW)(0u), rays->triangle);
}

// Shortens the parts [enter, leave] of ray i within W boxes to those between two planes across an
// axis.
CLPV_INLINE void clip_to_slabs(const Rays* rays, const uint i, const int axis, const realW near,
                               const realW far, realW* enter, realW* leave) {
  const realW from = (realW)(rays->from[axis][i]), inverse = (realW)(rays->inverse[axis][i]);
  const realW entered = (near - from) * inverse, left = (far - from) * inverse;
  *enter = entered > *enter ? entered : *enter;
  *leave = left < *leave ? left : *leave;
}

// Defines a function that returns a bit mask of the children of a node in `memory` whose boxes ray
// i meets before its hit.
#define CLPV_BOXES_HIT(name, memory)                                                \
  CLPV_INLINE uint name(memory const realW* node, const Rays* rays, const uint i) { \
    uint bits = 0;                                                                  \
    for (uint at = 0; at < CLPV_TREE_VECTORS; ++at) {                               \
      realW enter = ZERO, leave = (realW)(rays->distance[i]);                       \
      _Pragma("unroll") for (int a = 0; a < 3; ++a) {                               \
        const uint near = rays->near_row[a][i],                                     \
                   far = CLPV_TREE_LOWER + CLPV_TREE_UPPER + 2 * a - near;          \
        clip_to_slabs(rays, i, a, node[near * CLPV_TREE_VECTORS + at],              \
                      node[far * CLPV_TREE_VECTORS + at], &enter, &leave);          \
      }                                                                             \
      bits |= lane_bits(enter <= leave * box_margin) << (at * W);                   \
    }                                                                               \
    return bits;                                                                    \
  }
CLPV_BOXES_HIT(boxes_hit, __global)

static inline uint lowest_bit(const uint bits) {
  return 31u - clz(bits & (0u - bits));
}

// Mask of the lanes where a masked material has a hole at weights (u, v).
CLPV_OUT_OF_LINE_ON_CPUS
intW find_holes(const uintW triangle, const realW u, const realW v, CLPV_SCENE) {
  Rows indices, a, b, c, base, factors, maps;
  gather_rows(triangles, triangle, &indices);
  const uintW ia = as_uintW(CLPV_COLUMN(indices, x)), ib = as_uintW(CLPV_COLUMN(indices, y)),
              ic = as_uintW(CLPV_COLUMN(indices, z)), im = as_uintW(CLPV_COLUMN(indices, w));
  const Vec w = vec(1.0f - u - v, u, v);
  gather_rows(vertices + 2, 3u * ia, &a);
  gather_rows(vertices + 2, 3u * ib, &b);
  gather_rows(vertices + 2, 3u * ic, &c);
  const realW vertex_alpha =
      interpolated(w, CLPV_COLUMN(a, w), CLPV_COLUMN(b, w), CLPV_COLUMN(c, w));
  gather_rows(vertices + 1, 3u * ia, &a);
  gather_rows(vertices + 1, 3u * ib, &b);
  gather_rows(vertices + 1, 3u * ic, &c);
  const Uv uv = {interpolated(w, CLPV_COLUMN(a, z), CLPV_COLUMN(b, z), CLPV_COLUMN(c, z)),
                 interpolated(w, CLPV_COLUMN(a, w), CLPV_COLUMN(b, w), CLPV_COLUMN(c, w))};
  gather_rows(materials, 3u * im, &base);
  gather_rows(materials + 1, 3u * im, &factors);
  gather_rows(materials + 2, 3u * im, &maps);
  const realW alpha =
      CLPV_COLUMN(base, w) * vertex_alpha *
      sample_alpha(textures, texels, as_uintW(CLPV_COLUMN(maps, x)) * CLPV_TEXTURE_LEVELS, uv);
  return alpha < CLPV_COLUMN(factors, w);
}

// Possible hits on masked materials. take_masked() looks up W alphas at once and drops hits in
// holes.
typedef struct {
  float distance[W], u[W], v[W];
  uint triangle[W], ray[W];
} MaskedHits;

CLPV_INLINE void take_hit(Rays* rays, const uint i, const float distance, const float u,
                          const float v, const uint triangle) {
  rays->distance[i] = distance;
  rays->u[i] = u;
  rays->v[i] = v;
  rays->triangle[i] = triangle;
}

CLPV_INLINE void take_masked(const MaskedHits* masked, const uint count, CLPV_SCENE, Rays* rays) {
  if (count == 0) return;
  const uint holes = lane_bits(find_holes(load_lanes(masked->triangle), load_lanes(masked->u),
                                          load_lanes(masked->v), CLPV_PASS_SCENE));
  for (uint j = 0; j < count; ++j) {
    const uint i = masked->ray[j];
    if ((holes >> j & 1u) == 0u && masked->distance[j] < rays->distance[i])
      take_hit(rays, i, masked->distance[j], masked->u[j], masked->v[j], masked->triangle[j]);
  }
}

// Three rows of W triangles of a leaf, from `row` on. `leaf`: row 0 of these triangles.
CLPV_INLINE Vec load_leaf(__global const realW* leaf, const int row) {
  return vec(leaf[row * CLPV_TREE_VECTORS], leaf[(row + 1) * CLPV_TREE_VECTORS],
             leaf[(row + 2) * CLPV_TREE_VECTORS]);
}

// Takes the nearest of W triangles of a leaf if it is nearer than the hit of ray i. On a tie, the
// first triangle wins.
CLPV_INLINE void test_triangles(__global const realW* leaf, const uint i, CLPV_SCENE, Rays* rays,
                                MaskedHits* masked, uint* masked_count) {
  const Vec along =
      vec((realW)(rays->along[0][i]), (realW)(rays->along[1][i]), (realW)(rays->along[2][i]));
  const Vec edge1 = load_leaf(leaf, CLPV_TREE_EDGE1), edge2 = load_leaf(leaf, CLPV_TREE_EDGE2);
  const Vec origin =
      vec((realW)(rays->from[0][i]), (realW)(rays->from[1][i]), (realW)(rays->from[2][i]));
  const Vec from = vec_minus(origin, load_leaf(leaf, CLPV_TREE_CORNER));
  const Vec across = vec_cross(along, edge2), around = vec_cross(from, edge1);
  const realW scale = ONE / vec_dot(edge1, across);
  const realW u = vec_dot(from, across) * scale, v = vec_dot(along, around) * scale,
               distance = vec_dot(edge2, around) * scale;
  intW met = (u >= ZERO) & (v >= ZERO) & (u + v <= ONE) & (distance > ZERO) &
             (distance < (realW)(rays->distance[i]));
  if (no_lane(met)) return;
  const uintW triangle = as_uintW(leaf[CLPV_TREE_TRIANGLES * CLPV_TREE_VECTORS]);
  const intW unsure = met & ((triangle & CLPV_TREE_MASKED) != 0u);
  if (!no_lane(unsure)) {
    for (uint bits = lane_bits(unsure); bits != 0; bits &= bits - 1u) {
      const uint lane = lowest_bit(bits), j = *masked_count;
      masked->distance[j] = ((const float*)&distance)[lane];
      masked->u[j] = ((const float*)&u)[lane];
      masked->v[j] = ((const float*)&v)[lane];
      masked->triangle[j] = ((const uint*)&triangle)[lane] & ~CLPV_TREE_MASKED;
      masked->ray[j] = i;
      *masked_count = (j + 1) % W;
      if (j + 1 == W) take_masked(masked, W, CLPV_PASS_SCENE, rays);
    }
    met &= unsure == 0;
    if (no_lane(met)) return;
  }
  const realW reached = met ? distance : (realW)(INFINITY);
  const float nearest = min_lane(reached);
  const uint lane = lowest_bit(lane_bits(reached == (realW)(nearest)));
  if (nearest < rays->distance[i])
    take_hit(rays, i, nearest, ((const float*)&u)[lane], ((const float*)&v)[lane],
             ((const uint*)&triangle)[lane]);
}
