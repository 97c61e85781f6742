// SPDX-License-Identifier: MIT
// Tree of bounding boxes over the scene's triangles (host/pipeline/gather/triangle_tree.hpp), in
// rows of eight numbers; shared by host and kernels.
#pragma once

enum {
  CLPV_TREE_WIDTH = 8,  // children of a node, triangles of a leaf
  CLPV_TREE_DEPTH = 32,  // nodes on a path from the root to a leaf, at most
};

// Rows of a node: lower x, y, z and upper x, y, z of the children's boxes [m], and the children
// (int): the number of a node, or ~ the number of a leaf. Missing children have boxes that no ray
// hits. Node 0 is the root.
enum {
  CLPV_TREE_LOWER = 0,
  CLPV_TREE_UPPER = 3,
  CLPV_TREE_CHILDREN = 6,
  CLPV_TREE_NODE_ROWS = 8,
};

// Rows of a leaf: x, y, z of the first vertices and of the edges to the second and the third ones
// [m], and the triangles (uint): index in the scene, plus CLPV_TREE_MASKED for a masked material.
// Missing triangles have no area.
enum {
  CLPV_TREE_CORNER = 0,
  CLPV_TREE_EDGE1 = 3,
  CLPV_TREE_EDGE2 = 6,
  CLPV_TREE_TRIANGLES = 9,
  CLPV_TREE_LEAF_ROWS = 10,
};

#define CLPV_TREE_MASKED 0x80000000u
#define CLPV_TREE_FAR 1e30f  // [m] coordinate of the boxes of missing children
