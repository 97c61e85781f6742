// SPDX-License-Identifier: MIT
// Nearest triangle along a ray: a tree of bounding boxes with eight children per node (shared/tree.h).
//
// A ray tests the eight boxes of a node, or the eight triangles of a leaf, in lanes. Triangles: Moeller and Trumbore
// 1997, 'Fast, minimum storage ray-triangle intersection'. Both sides are hit; holes of masked materials are not.
#ifndef CLPV_TRIANGLE_TREE_H
#define CLPV_TRIANGLE_TREE_H

#include "scene_triangles.h"
#include "shared/tree.h"

typedef struct {
  __global const float8 *nodes, *leaves;
} Tree;

typedef struct {
  float from[3], along[3], inverse[3];  // origin [m], unit direction, 1 / direction
  uint near_row[3], far_row[3];         // rows of a node that hold the nearer and the farther planes
} Ray;

typedef struct {
  float distance;  // [m]
  float u, v;      // weights of the second and third vertex
  uint triangle;
} Hit;

#define CLPV_BOX_MARGIN 1.000001f  // covers the rounding of distances to planes

CLPV_INLINE void clpv_make_ray(const float x, const float y, const float z, const float dx, const float dy, const float dz,
                          Ray* ray) {
  ray->from[0] = x, ray->from[1] = y, ray->from[2] = z;
  ray->along[0] = dx, ray->along[1] = dy, ray->along[2] = dz;
  for (int a = 0; a < 3; ++a) {
    const float d = ray->along[a], least = 1e-20f;
    ray->inverse[a] = 1.0f / (fabs(d) > least ? d : (d < 0.0f ? -least : least));
    ray->near_row[a] = (d < 0.0f ? CLPV_TREE_UPPER : CLPV_TREE_LOWER) + a;
    ray->far_row[a] = (d < 0.0f ? CLPV_TREE_LOWER : CLPV_TREE_UPPER) + a;
  }
}

// Bit mask of the children whose boxes the ray meets before `reach` [m].
#define CLPV_BOXES_HIT(name, memory)                                                                     \
CLPV_INLINE uint name(memory const float8* node, const Ray* ray, const float reach) { \
  const float8 nx = (node[ray->near_row[0]] - ray->from[0]) * ray->inverse[0], \
               ny = (node[ray->near_row[1]] - ray->from[1]) * ray->inverse[1], \
               nz = (node[ray->near_row[2]] - ray->from[2]) * ray->inverse[2]; \
  const float8 fx = (node[ray->far_row[0]] - ray->from[0]) * ray->inverse[0], \
               fy = (node[ray->far_row[1]] - ray->from[1]) * ray->inverse[1], \
               fz = (node[ray->far_row[2]] - ray->from[2]) * ray->inverse[2]; \
  const float8 none = (float8)(0.0f), end = (float8)(reach); \
  const float8 nxy = nx > ny ? nx : ny, nz0 = nz > none ? nz : none, enter = nxy > nz0 ? nxy : nz0; \
  const float8 fxy = fx < fy ? fx : fy, fz1 = fz < end ? fz : end, leave = fxy < fz1 ? fxy : fz1; \
  return clpv_bits(enter <= leave * CLPV_BOX_MARGIN); \
}
CLPV_BOXES_HIT(clpv_boxes_hit, __global)
CLPV_BOXES_HIT(clpv_entry_hit, )

static inline uint clpv_lowest(const uint bits) {
  return 31u - clz(bits & (0u - bits));
}

// Child `lane` of a node.
static inline int clpv_child(__global const float8* node, const uint lane) {
  return ((__global const int*)(node + CLPV_TREE_CHILDREN))[lane];
}

// Mask of the lanes where a masked material has a hole at weights (u, v). Other lanes may be anything.
__attribute__((noinline)) int8 clpv_holes(const uint8 triangle, const float8 u, const float8 v, CLPV_SCENE) {
  Rows indices, a, b, c, base, factors, maps;
  gather_rows(triangles, triangle & ~CLPV_TREE_MASKED, &indices);
  const uint8 ia = as_uint8(CLPV_COLUMN(indices, x)), ib = as_uint8(CLPV_COLUMN(indices, y)),
              ic = as_uint8(CLPV_COLUMN(indices, z)), im = as_uint8(CLPV_COLUMN(indices, w));
  const float8 w = 1.0f - u - v;
  gather_rows(vertices + 2, 3u * ia, &a);
  gather_rows(vertices + 2, 3u * ib, &b);
  gather_rows(vertices + 2, 3u * ic, &c);
  const float8 vertex_alpha = w * CLPV_COLUMN(a, w) + u * CLPV_COLUMN(b, w) + v * CLPV_COLUMN(c, w);
  gather_rows(vertices + 1, 3u * ia, &a);
  gather_rows(vertices + 1, 3u * ib, &b);
  gather_rows(vertices + 1, 3u * ic, &c);
  const Uv uv = {w * CLPV_COLUMN(a, z) + u * CLPV_COLUMN(b, z) + v * CLPV_COLUMN(c, z),
                 w * CLPV_COLUMN(a, w) + u * CLPV_COLUMN(b, w) + v * CLPV_COLUMN(c, w)};
  gather_rows(materials, 3u * im, &base);
  gather_rows(materials + 1, 3u * im, &factors);
  gather_rows(materials + 2, 3u * im, &maps);
  const float8 alpha = CLPV_COLUMN(base, w) * vertex_alpha *
                       clpv_bilinear_alpha(textures, texels, as_uint8(CLPV_COLUMN(maps, x)) * CLPV_TEXTURE_LEVELS, uv);
  return (alpha < CLPV_COLUMN(factors, w)) & ((triangle & CLPV_TREE_MASKED) != 0u);
}

static inline float clpv_least(const float8 v) {
  const float4 four = v.lo < v.hi ? v.lo : v.hi;
  const float2 two = four.lo < four.hi ? four.lo : four.hi;
  return two.x < two.y ? two.x : two.y;
}

// Takes the nearest triangle of a leaf that is nearer than `hit`; of equals the first.
CLPV_INLINE void clpv_leaf_hit(__global const float8* leaf, const Ray* ray, CLPV_SCENE, Hit* hit) {
  const Vec along = vec((float8)(ray->along[0]), (float8)(ray->along[1]), (float8)(ray->along[2]));
  const Vec edge1 = vec(leaf[CLPV_TREE_EDGE1], leaf[CLPV_TREE_EDGE1 + 1], leaf[CLPV_TREE_EDGE1 + 2]);
  const Vec edge2 = vec(leaf[CLPV_TREE_EDGE2], leaf[CLPV_TREE_EDGE2 + 1], leaf[CLPV_TREE_EDGE2 + 2]);
  const Vec from = vec(ray->from[0] - leaf[CLPV_TREE_CORNER], ray->from[1] - leaf[CLPV_TREE_CORNER + 1],
                       ray->from[2] - leaf[CLPV_TREE_CORNER + 2]);
  const Vec across = vec_cross(along, edge2), around = vec_cross(from, edge1);
  const float8 zero = (float8)(0.0f), one = (float8)(1.0f), scale = one / vec_dot(edge1, across);
  const float8 u = vec_dot(from, across) * scale, v = vec_dot(along, around) * scale,
               distance = vec_dot(edge2, around) * scale;
  int8 met = (u >= zero) & (v >= zero) & (u + v <= one) & (distance > zero) & (distance < (float8)(hit->distance));
  if (none(met)) return;
  const uint8 triangle = as_uint8(leaf[CLPV_TREE_TRIANGLES]);
  if (!none(met & ((triangle & CLPV_TREE_MASKED) != 0u))) {
    met &= ~clpv_holes(triangle, u, v, CLPV_PASS_SCENE);
    if (none(met)) return;
  }
  const float8 reached = met ? distance : (float8)(INFINITY);
  const float nearest = clpv_least(reached);
  const uint bits = clpv_bits(reached == (float8)(nearest));
  const uint lane = clpv_lowest(bits);
  hit->distance = nearest;
  hit->u = ((const float*)&u)[lane];
  hit->v = ((const float*)&v)[lane];
  hit->triangle = ((const uint*)&triangle)[lane] & ~CLPV_TREE_MASKED;
}

// Takes the nearest triangle below a node, if it is nearer than `hit`. The stack has one entry per level: a node and the
// bit mask of its children to visit.
CLPV_INLINE void clpv_subtree_hit(const Tree tree, uint node, const Ray* ray, CLPV_SCENE, Hit* hit) {
  uint stack[CLPV_TREE_DEPTH];
  uint depth = 0, children = clpv_boxes_hit(tree.nodes + (size_t)node * CLPV_TREE_NODE_ROWS, ray, hit->distance);
  for (;;) {
    if (children == 0) {
      if (depth == 0) return;
      const uint top = stack[--depth];
      node = top >> CLPV_TREE_WIDTH;
      children = top & ((1u << CLPV_TREE_WIDTH) - 1u);
    }
    const int child = clpv_child(tree.nodes + (size_t)node * CLPV_TREE_NODE_ROWS, clpv_lowest(children));
    children &= children - 1u;
    if (child < 0) {
      clpv_leaf_hit(tree.leaves + (size_t)(uint)~child * CLPV_TREE_LEAF_ROWS, ray, CLPV_PASS_SCENE, hit);
      continue;
    }
    if (children != 0) stack[depth++] = node << CLPV_TREE_WIDTH | children;
    node = (uint)child;
    children = clpv_boxes_hit(tree.nodes + (size_t)node * CLPV_TREE_NODE_ROWS, ray, hit->distance);
  }
}

// Up to eight subtrees that hold all triangles in a box: a node (shared/tree.h) that rays of one region share.
typedef struct {
  float8 rows[CLPV_TREE_CHILDREN + 1];
} Entry;

typedef struct {
  float lower[3], upper[3];  // [m]
} Box;

// Bit mask of the children of a node that overlap a box.
CLPV_INLINE uint clpv_overlaps(__global const float8* node, const Box box) {
  int8 overlaps = (int8)(-1);
  for (int a = 0; a < 3; ++a)
    overlaps &= (node[CLPV_TREE_LOWER + a] <= box.upper[a]) & (node[CLPV_TREE_UPPER + a] >= box.lower[a]);
  return clpv_bits(overlaps);
}

#define CLPV_ENTRY_STEPS 24  // subtrees to look at, at most

// Opens nodes in order, from the root on, as long as the children that overlap the box fit.
CLPV_INLINE void clpv_enter(const Tree tree, const Box box, Entry* entry) {
  float rows[CLPV_TREE_CHILDREN][CLPV_TREE_WIDTH];
  int children[CLPV_TREE_WIDTH];
  for (uint lane = 0; lane < CLPV_TREE_WIDTH; ++lane) {
    for (int row = 0; row < CLPV_TREE_CHILDREN; ++row)
      rows[row][lane] = row < CLPV_TREE_UPPER ? CLPV_TREE_FAR : -CLPV_TREE_FAR;
    children[lane] = -1;
  }
  children[0] = 0;
  uint count = 1, next = 0;
  for (uint step = 0; step < CLPV_ENTRY_STEPS && next < count; ++step) {
    __global const float8* node = tree.nodes + (size_t)(uint)max(children[next], 0) * CLPV_TREE_NODE_ROWS;
    uint overlaps = clpv_overlaps(node, box), lane = next, free = count;
    if (children[next] < 0 || count - 1 + popcount(overlaps) > CLPV_TREE_WIDTH) {
      ++next;
      continue;
    }
    if (overlaps == 0) {  // nothing in reach below it
      for (int row = 0; row < CLPV_TREE_CHILDREN; ++row)
        rows[row][lane] = row < CLPV_TREE_UPPER ? CLPV_TREE_FAR : -CLPV_TREE_FAR;
      children[lane] = -1;
      continue;
    }
    count += popcount(overlaps) - 1;
    for (; overlaps != 0; lane = free++) {
      const uint child = clpv_lowest(overlaps);
      overlaps &= overlaps - 1u;
      for (int row = 0; row < CLPV_TREE_CHILDREN; ++row) rows[row][lane] = ((__global const float*)(node + row))[child];
      children[lane] = clpv_child(node, child);
    }
  }
  for (int row = 0; row < CLPV_TREE_CHILDREN; ++row) entry->rows[row] = vload8(0, rows[row]);
  entry->rows[CLPV_TREE_CHILDREN] = as_float8(vload8(0, children));
}

// Finds the nearest triangle before hit->distance [m]. Returns false, and leaves `hit`, if there is none.
CLPV_INLINE bool clpv_nearest_triangle(const Tree tree, const Entry* entry, const Ray* ray, CLPV_SCENE, Hit* hit) {
  const float reach = hit->distance;
  uint children = clpv_entry_hit(entry->rows, ray, reach);
  while (children != 0) {
    const int child = ((const int*)&entry->rows[CLPV_TREE_CHILDREN])[clpv_lowest(children)];
    children &= children - 1u;
    if (child < 0) {
      clpv_leaf_hit(tree.leaves + (size_t)(uint)~child * CLPV_TREE_LEAF_ROWS, ray, CLPV_PASS_SCENE, hit);
    } else {
      clpv_subtree_hit(tree, (uint)child, ray, CLPV_PASS_SCENE, hit);
    }
  }
  return hit->distance < reach;
}

#endif
