// SPDX-License-Identifier: MIT
// Nearest triangle along a ray: a tree of bounding boxes with eight children per node (shared/tree.h).
//
// A ray tests the eight boxes of a node, or the eight triangles of a leaf, W at a time. Triangles: Moeller and Trumbore
// 1997, 'Fast, minimum storage ray-triangle intersection'. Both sides are hit; holes of masked materials are not.
//
// W rays share lists of nodes and leaves to visit. Processors test the entries of a list at the same time, while a
// depth-first traversal waits for each node before it knows the next. One ray visits nodes depth first, with a stack.
#pragma once

#include "raster/scene_triangles.h"
#include "shared/tree.h"

typedef struct {
  __global const realW *nodes, *leaves;
} Tree;

#define CLPV_TREE_VECTORS (CLPV_TREE_WIDTH / W)  // of W numbers in a row of a node or a leaf

// W rays and their nearest hits.
typedef struct {
  float from[3][W], along[3][W], inverse[3][W];  // [m]; unit; 1 / along
  uint near_row[3][W];  // row of a node that holds the nearer planes
  float distance[W];   // of the hit [m], or reach of the ray
  float u[W], v[W];  // weights of the second and third vertex
  uint triangle[W];
} Rays;

#define CLPV_BOX_MARGIN 1.000001f  // covers the rounding of distances to planes

CLPV_INLINE void set_ray_axis(const int axis, const realW from, const realW along, Rays* rays) {
  const realW least = along < ZERO ? (realW)(-1e-20f) : (realW)(1e-20f);
  store_lanes(from, rays->from[axis]);
  store_lanes(along, rays->along[axis]);
  store_lanes(1.0f / (fabs(along) > fabs(least) ? along : least), rays->inverse[axis]);
  store_lanes(along < ZERO ? (uintW)(CLPV_TREE_UPPER + axis) : (uintW)(CLPV_TREE_LOWER + axis), rays->near_row[axis]);
}

// Rays without hits; those of reach 0 have none.
CLPV_INLINE void set_rays(const Vec from, const Vec along, const realW reach, Rays* rays) {
  set_ray_axis(0, from.x, along.x, rays);
  set_ray_axis(1, from.y, along.y, rays);
  set_ray_axis(2, from.z, along.z, rays);
  store_lanes(reach, rays->distance);
  store_lanes(ZERO, rays->u);
  store_lanes(ZERO, rays->v);
  store_lanes((uintW)(0u), rays->triangle);
}

// Shortens the parts of ray i within W boxes to those between their planes across axis a.
#define CLPV_MEET_SLABS(a)                                                                                       \
  {                                                                                                              \
    const uint near_row = rays->near_row[a][i], far_row = CLPV_TREE_LOWER + CLPV_TREE_UPPER + 2 * a - near_row;  \
    const realW from = (realW)(rays->from[a][i]), inverse = (realW)(rays->inverse[a][i]);                     \
    const realW entered = (node[near_row * CLPV_TREE_VECTORS + at] - from) * inverse,                            \
                left = (node[far_row * CLPV_TREE_VECTORS + at] - from) * inverse;                                \
    enter = entered > enter ? entered : enter;                                                                   \
    leave = left < leave ? left : leave;                                                                         \
  }

// Bit mask of the children whose boxes ray i meets before its hit.
#define CLPV_BOXES_HIT(name, memory)                                                                                  \
  CLPV_INLINE uint name(memory const realW* node, const Rays* rays, const uint i) {                                  \
    uint bits = 0;                                                                                                    \
    for (uint at = 0; at < CLPV_TREE_VECTORS; ++at) {                                                                 \
      realW enter = ZERO, leave = (realW)(rays->distance[i]);                                                         \
      CLPV_MEET_SLABS(0) CLPV_MEET_SLABS(1) CLPV_MEET_SLABS(2)                                                        \
      bits |= lane_bits(enter <= leave * CLPV_BOX_MARGIN) << (at * W);                                                \
    }                                                                                                                 \
    return bits;                                                                                                      \
  }
CLPV_BOXES_HIT(boxes_hit, __global)
#if W > 1
CLPV_BOXES_HIT(entry_hit, )
#endif

static inline uint lowest_bit(const uint bits) {
  return 31u - clz(bits & (0u - bits));
}

// Mask of the lanes where a masked material has a hole at weights (u, v).
CLPV_RARE intW find_holes(const uintW triangle, const realW u, const realW v, CLPV_SCENE) {
  Rows indices, a, b, c, base, factors, maps;
  gather_rows(triangles, triangle, &indices);
  const uintW ia = as_uintW(CLPV_COLUMN(indices, x)), ib = as_uintW(CLPV_COLUMN(indices, y)),
              ic = as_uintW(CLPV_COLUMN(indices, z)), im = as_uintW(CLPV_COLUMN(indices, w));
  const realW w = 1.0f - u - v;
  gather_rows(vertices + 2, 3u * ia, &a);
  gather_rows(vertices + 2, 3u * ib, &b);
  gather_rows(vertices + 2, 3u * ic, &c);
  const realW vertex_alpha = w * CLPV_COLUMN(a, w) + u * CLPV_COLUMN(b, w) + v * CLPV_COLUMN(c, w);
  gather_rows(vertices + 1, 3u * ia, &a);
  gather_rows(vertices + 1, 3u * ib, &b);
  gather_rows(vertices + 1, 3u * ic, &c);
  const Uv uv = {w * CLPV_COLUMN(a, z) + u * CLPV_COLUMN(b, z) + v * CLPV_COLUMN(c, z),
                 w * CLPV_COLUMN(a, w) + u * CLPV_COLUMN(b, w) + v * CLPV_COLUMN(c, w)};
  gather_rows(materials, 3u * im, &base);
  gather_rows(materials + 1, 3u * im, &factors);
  gather_rows(materials + 2, 3u * im, &maps);
  const realW alpha = CLPV_COLUMN(base, w) * vertex_alpha *
                       sample_alpha(textures, texels, as_uintW(CLPV_COLUMN(maps, x)) * CLPV_TEXTURE_LEVELS, uv);
  return alpha < CLPV_COLUMN(factors, w);
}

// Hits on masked materials, which count unless there is a hole. W are looked up together.
typedef struct {
  float distance[W], u[W], v[W];
  uint triangle[W], ray[W];
} MaskedHits;

CLPV_INLINE void take_hit(Rays* rays, const uint i, const float distance, const float u, const float v,
                          const uint triangle) {
  rays->distance[i] = distance;
  rays->u[i] = u;
  rays->v[i] = v;
  rays->triangle[i] = triangle;
}

CLPV_INLINE void take_masked(const MaskedHits* masked, const uint count, CLPV_SCENE, Rays* rays) {
  if (count == 0) return;
  const uint holes = lane_bits(find_holes(load_lanes(masked->triangle), load_lanes(masked->u), load_lanes(masked->v),
                                          CLPV_PASS_SCENE));
  for (uint j = 0; j < count; ++j) {
    const uint i = masked->ray[j];
    if ((holes >> j & 1u) == 0u && masked->distance[j] < rays->distance[i])
      take_hit(rays, i, masked->distance[j], masked->u[j], masked->v[j], masked->triangle[j]);
  }
}

// Takes the nearest of W triangles of a leaf if it is nearer than the hit of ray i. On a tie, the first
// triangle wins. `leaf`: row 0 of these triangles.
#define CLPV_LEAF(row) leaf[(row) * CLPV_TREE_VECTORS]
CLPV_INLINE void test_triangles(__global const realW* leaf, const uint i, CLPV_SCENE, Rays* rays, MaskedHits* masked,
                           uint* masked_count) {
  const Vec along = vec((realW)(rays->along[0][i]), (realW)(rays->along[1][i]), (realW)(rays->along[2][i]));
  const Vec edge1 = vec(CLPV_LEAF(CLPV_TREE_EDGE1), CLPV_LEAF(CLPV_TREE_EDGE1 + 1), CLPV_LEAF(CLPV_TREE_EDGE1 + 2));
  const Vec edge2 = vec(CLPV_LEAF(CLPV_TREE_EDGE2), CLPV_LEAF(CLPV_TREE_EDGE2 + 1), CLPV_LEAF(CLPV_TREE_EDGE2 + 2));
  const Vec from = vec(rays->from[0][i] - CLPV_LEAF(CLPV_TREE_CORNER), rays->from[1][i] - CLPV_LEAF(CLPV_TREE_CORNER + 1),
                       rays->from[2][i] - CLPV_LEAF(CLPV_TREE_CORNER + 2));
  const Vec across = vec_cross(along, edge2), around = vec_cross(from, edge1);
  const realW scale = ONE / vec_dot(edge1, across);
  const realW u = vec_dot(from, across) * scale, v = vec_dot(along, around) * scale,
               distance = vec_dot(edge2, around) * scale;
  intW met = (u >= ZERO) & (v >= ZERO) & (u + v <= ONE) & (distance > ZERO) & (distance < (realW)(rays->distance[i]));
  if (no_lane(met)) return;
  const uintW triangle = as_uintW(CLPV_LEAF(CLPV_TREE_TRIANGLES));
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
    take_hit(rays, i, nearest, ((const float*)&u)[lane], ((const float*)&v)[lane], ((const uint*)&triangle)[lane]);
}
#undef CLPV_LEAF

#if W > 1

// Where a work-item's rays begin. Up to eight subtrees that hold all triangles in a box: a node
// (shared/tree.h) that rays of one region share.
typedef struct {
  realW rows[CLPV_TREE_CHILDREN + 1];
} Entry;

typedef struct {
  float lower[3], upper[3];  // [m]
} Box;

// Bit mask of the children of a node that overlap a box.
CLPV_INLINE uint find_overlaps(__global const realW* node, const Box box) {
  intW overlaps = (intW)(-1);
  for (int a = 0; a < 3; ++a)
    overlaps &= (node[CLPV_TREE_LOWER + a] <= box.upper[a]) & (node[CLPV_TREE_UPPER + a] >= box.lower[a]);
  return lane_bits(overlaps);
}

#define CLPV_ENTRY_STEPS 24  // subtrees to look at, at most

// Opens nodes in order, from the root on, as long as the children that overlap the box fit.
CLPV_INLINE void enter_tree(const Tree tree, const Box box, Entry* entry) {
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
    __global const realW* node = tree.nodes + (size_t)(uint)max(children[next], 0) * CLPV_TREE_NODE_ROWS;
    uint overlaps = find_overlaps(node, box), lane = next, free = count;
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
      const uint child = lowest_bit(overlaps);
      overlaps &= overlaps - 1u;
      for (int row = 0; row < CLPV_TREE_CHILDREN; ++row) rows[row][lane] = ((__global const float*)(node + row))[child];
      children[lane] = ((__global const int*)(node + CLPV_TREE_CHILDREN))[child];
    }
  }
  for (int row = 0; row < CLPV_TREE_CHILDREN; ++row) entry->rows[row] = load_lanes(rows[row]);
  entry->rows[CLPV_TREE_CHILDREN] = as_realW(load_lanes(children));
}

// Entries of the lists: number of a node or a leaf, and a ray in the lowest bits.
#define CLPV_RAY_BITS 3
#define CLPV_LIST 256  // entries, before the last node or leaf adds its own

// Adds the children in the mask `bits` of a node for ray i.
#define CLPV_ADD_CHILDREN(memory, node, bits, i)                                                        \
  for (uint rest = bits; rest != 0; rest &= rest - 1u) {                                                \
    const int child = ((memory const int*)((node) + CLPV_TREE_CHILDREN))[lowest_bit(rest)];            \
    const uint inner = child >= 0;                                                                      \
    nodes[node_count] = (uint)child << CLPV_RAY_BITS | i;                                               \
    leaves[leaf_count] = (uint)~child << CLPV_RAY_BITS | i;                                             \
    node_count += inner;                                                                                \
    leaf_count += 1u - inner;                                                                           \
  }

// Finds the nearest triangle of each ray. Nodes are visited in the order in which they were found; once the list is
// long the last first, for which the rest of the array suffices.
CLPV_INLINE void trace_rays(const Tree tree, const Entry* entry, CLPV_SCENE, Rays* rays) {
  uint nodes[CLPV_LIST + CLPV_TREE_WIDTH * CLPV_TREE_DEPTH], leaves[CLPV_LIST + CLPV_TREE_WIDTH];
  uint visited = 0, node_count = 0, leaf_count = 0, masked_count = 0;
  MaskedHits masked;
  store_lanes((uintW)(0u), masked.triangle);
  store_lanes(ZERO, masked.u), store_lanes(ZERO, masked.v);  // of unused lanes, too
  for (uint i = 0; i < W; ++i) {
    const uint bits = rays->distance[i] > 0.0f ? entry_hit(entry->rows, rays, i) : 0u;
    CLPV_ADD_CHILDREN(, entry->rows, bits, i)
  }
  while (visited < node_count || leaf_count > 0) {
    while (visited < node_count && leaf_count <= CLPV_LIST) {
      const uint next = nodes[node_count > CLPV_LIST ? --node_count : visited++], i = next % W;
      __global const realW* node =
          tree.nodes + (size_t)(next >> CLPV_RAY_BITS) * (CLPV_TREE_NODE_ROWS * CLPV_TREE_VECTORS);
      const uint bits = boxes_hit(node, rays, i);
      CLPV_ADD_CHILDREN(__global, node, bits, i)
    }
    for (uint j = 0; j < leaf_count; ++j) {
      __global const realW* leaf =
          tree.leaves + (size_t)(leaves[j] >> CLPV_RAY_BITS) * (CLPV_TREE_LEAF_ROWS * CLPV_TREE_VECTORS);
      for (uint at = 0; at < CLPV_TREE_VECTORS; ++at)
        test_triangles(leaf + at, leaves[j] % W, CLPV_PASS_SCENE, rays, &masked, &masked_count);
    }
    leaf_count = 0;
  }
  take_masked(&masked, masked_count, CLPV_PASS_SCENE, rays);
}

#else

// Nodes of whose children a ray has yet to visit those in a bit mask. Work-groups are CLPV_STACK_SIDE^2 work-items. Each has a
// stack of CLPV_TREE_DEPTH in local memory, since GPUs keep private arrays in scratch memory. Entries of neighbouring work-items
// are neighbours.
#define CLPV_STACK_SIDE 8
#define CLPV_STACK_STEP (CLPV_STACK_SIDE * CLPV_STACK_SIDE)
#define CLPV_STACKS (CLPV_TREE_DEPTH * CLPV_STACK_STEP)
typedef struct {
  __local uint* nodes;
  __local uchar* children;
} Stack;

// Finds the nearest triangle of a ray. `stack`: first entries of this work-item.
CLPV_INLINE void trace_ray(const Tree tree, const Stack stack, CLPV_SCENE, Rays* rays) {
  uint depth = 0, masked_count = 0, at = 0;  // the root
  MaskedHits masked;
  if (!(rays->distance[0] > 0.0f)) return;
  uint unvisited = boxes_hit(tree.nodes, rays, 0);
  for (;;) {
    if (unvisited == 0u) {
      if (depth == 0) return;
      --depth;
      at = stack.nodes[depth * CLPV_STACK_STEP];
      unvisited = stack.children[depth * CLPV_STACK_STEP];
    }
    __global const realW* node = tree.nodes + (size_t)at * (CLPV_TREE_NODE_ROWS * CLPV_TREE_WIDTH);
    const uint lane = lowest_bit(unvisited);
    unvisited &= unvisited - 1u;
    const int child = as_int(node[CLPV_TREE_CHILDREN * CLPV_TREE_WIDTH + lane]);
    if (child < 0) {
      __global const realW* leaf = tree.leaves + (size_t)(uint)~child * (CLPV_TREE_LEAF_ROWS * CLPV_TREE_WIDTH);
      for (uint i = 0; i < CLPV_TREE_WIDTH; ++i)
        test_triangles(leaf + i, 0, CLPV_PASS_SCENE, rays, &masked, &masked_count);
      continue;
    }
    if (unvisited != 0u) {
      stack.nodes[depth * CLPV_STACK_STEP] = at;
      stack.children[depth * CLPV_STACK_STEP] = (uchar)unvisited;
      ++depth;
    }
    at = (uint)child;
    unvisited = boxes_hit(tree.nodes + (size_t)at * (CLPV_TREE_NODE_ROWS * CLPV_TREE_WIDTH), rays, 0);
  }
}

#endif
