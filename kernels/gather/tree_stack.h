// SPDX-License-Identifier: MIT
// Walk of one ray through the tree of triangles, for GPUs: depth first, with a stack.
#pragma once

#include "gather/triangle_tree.h"

// Stack of nodes, each with a bit mask of the children that are still to be visited. Work-groups
// are CLPV_STACK_SIDE^2 work-items. Each has a stack of CLPV_TREE_DEPTH in local memory, since GPUs
// keep private arrays in scratch memory. Entries of neighbouring work-items are neighbours.
enum {
  CLPV_STACK_SIDE = 8,
  CLPV_STACK_STEP = CLPV_STACK_SIDE * CLPV_STACK_SIDE,
  CLPV_STACKS = CLPV_TREE_DEPTH * CLPV_STACK_STEP,
};
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
      __global const realW* leaf =
          tree.leaves + (size_t)(uint)~child * (CLPV_TREE_LEAF_ROWS * CLPV_TREE_WIDTH);
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
    unvisited =
        boxes_hit(tree.nodes + (size_t)at * (CLPV_TREE_NODE_ROWS * CLPV_TREE_WIDTH), rays, 0);
  }
}
