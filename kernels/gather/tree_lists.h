// SPDX-License-Identifier: MIT
// Walk of W rays through the tree of triangles, for CPUs: they share lists of nodes and leaves to
// visit. Processors test the entries of a list at the same time, while a depth-first traversal
// waits for each node before it knows the next.
#pragma once

#include "gather/triangle_tree.h"

// Start of a work-item's rays: a node (rows as in shared/tree.h) made of up to eight subtrees that
// hold all triangles in the rays' box.
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
    overlaps &=
        (node[CLPV_TREE_LOWER + a] <= box.upper[a]) & (node[CLPV_TREE_UPPER + a] >= box.lower[a]);
  return lane_bits(overlaps);
}

enum { CLPV_ENTRY_STEPS = 24 };  // subtrees to look at, at most

// From the root on, replaces nodes by their children that overlap the box, as long as all fit into
// eight.
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
    __global const realW* node =
        tree.nodes + (size_t)(uint)max(children[next], 0) * CLPV_TREE_NODE_ROWS;
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
      for (int row = 0; row < CLPV_TREE_CHILDREN; ++row)
        rows[row][lane] = ((__global const float*)(node + row))[child];
      children[lane] = ((__global const int*)(node + CLPV_TREE_CHILDREN))[child];
    }
  }
  for (int row = 0; row < CLPV_TREE_CHILDREN; ++row) entry->rows[row] = load_lanes(rows[row]);
  entry->rows[CLPV_TREE_CHILDREN] = as_realW(load_lanes(children));
}

CLPV_BOXES_HIT(entry_hit, )

// Entries of the lists: number of a node or a leaf, and a ray in the lowest bits.
enum {
  CLPV_RAY_BITS = 3,
  CLPV_LIST = 256,  // entries, before the last node or leaf adds its own
};

// Adds the children in the mask `bits` of a node for ray i.
#define CLPV_ADD_CHILDREN(memory, node, bits, i)                                            \
  for (uint rest = bits; rest != 0; rest &= rest - 1u) {                                    \
    const int child = ((memory const int*)((node) + CLPV_TREE_CHILDREN))[lowest_bit(rest)]; \
    const uint inner = child >= 0;                                                          \
    nodes[node_count] = (uint)child << CLPV_RAY_BITS | i;                                   \
    leaves[leaf_count] = (uint)~child << CLPV_RAY_BITS | i;                                 \
    node_count += inner;                                                                    \
    leaf_count += 1u - inner;                                                               \
  }

// Finds the nearest triangle of each ray. Breadth first; beyond CLPV_LIST nodes depth first, which
// adds at most CLPV_TREE_WIDTH * CLPV_TREE_DEPTH more.
CLPV_INLINE void trace_rays(const Tree tree, const Entry* entry, CLPV_SCENE, Rays* rays) {
  uint nodes[CLPV_LIST + CLPV_TREE_WIDTH * CLPV_TREE_DEPTH], leaves[CLPV_LIST + CLPV_TREE_WIDTH];
  uint visited = 0, node_count = 0, leaf_count = 0, masked_count = 0;
  MaskedHits masked;
  store_lanes((uintW)(0u), masked.triangle);
  store_lanes(ZERO, masked.u), store_lanes(ZERO, masked.v);  // unused lanes, too
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
      __global const realW* leaf = tree.leaves + (size_t)(leaves[j] >> CLPV_RAY_BITS) *
                                                     (CLPV_TREE_LEAF_ROWS * CLPV_TREE_VECTORS);
      for (uint at = 0; at < CLPV_TREE_VECTORS; ++at)
        test_triangles(leaf + at, leaves[j] % W, CLPV_PASS_SCENE, rays, &masked, &masked_count);
    }
    leaf_count = 0;
  }
  take_masked(&masked, masked_count, CLPV_PASS_SCENE, rays);
}
