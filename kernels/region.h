// SPDX-License-Identifier: MIT
// The cells that are made anew (shared/region.h), and the triangles that may leave something in them.
#ifndef CLPV_REGION_H
#define CLPV_REGION_H

#include "shared/mesh.h"
#include "shared/region.h"

// Regions are arguments by value, whose arrays are only ever indexed by literals: where an index is known at run time alone,
// the compiler of Mesa's rusticl 22.3 crashes.

// Of three numbers that of an axis.
static inline int clpv_of_axis(const int v[3], const uint axis) { return axis == 0 ? v[0] : (axis == 1 ? v[1] : v[2]); }

// Whether a cell inside `region.all` is one of them.
static inline bool clpv_in_region(const ClpvRegion* region, const int x, const int y, const int z) {
  if (region->boxes == 1) return true;
#define CLPV_IN_BOX(b)                                                                                                 \
  ((region->boxes > b) & (x >= region->box[b].low[0]) & (x <= region->box[b].high[0]) & (y >= region->box[b].low[1]) & \
   (y <= region->box[b].high[1]) & (z >= region->box[b].low[2]) & (z <= region->box[b].high[2]))
  return CLPV_IN_BOX(0) | CLPV_IN_BOX(1) | CLPV_IN_BOX(2) | CLPV_IN_BOX(3) | CLPV_IN_BOX(4) | CLPV_IN_BOX(5) |
         CLPV_IN_BOX(6) | CLPV_IN_BOX(7);
#undef CLPV_IN_BOX
}
#if CLPV_REGION_BOXES != 8
#error "clpv_in_region tells of eight boxes"
#endif

// The arguments of kernels that go through triangles, an item each, a group a run: those of `clusters` from `first_cluster` on;
// `triangle_count`: of the scene.
#define CLPV_TRIANGLES                                                                                      \
  __global const uint *clusters, const uint first_cluster, const uint cluster_count, const uint triangle_count,         \
      __global const ClpvVertex *vertices, __global const ClpvTriangle *triangles, __global const ClpvMaterial *materials

// The number of the item's triangle; triangle_count or more: it has none.
#define CLPV_TRIANGLE_NUMBER                                                                                         \
  (get_global_id(0) / CLPV_CLUSTER < cluster_count                                                                           \
       ? clusters[first_cluster + get_global_id(0) / CLPV_CLUSTER] * CLPV_CLUSTER + (uint)get_global_id(0) % CLPV_CLUSTER                \
       : triangle_count)

#endif
