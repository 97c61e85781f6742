// SPDX-License-Identifier: MIT
// Tests whether a cell must be voxelised again (shared/region.h), and assigns each re-voxelising
// work-item its triangle.
#pragma once

#include "shared/mesh.h"
#include "shared/region.h"

// Regions are passed by value, and their arrays are indexed only by literals: an index known only
// at run time crashes the compiler of Mesa's rusticl 22.3.

// Component of a vector along an axis.
static inline int of_axis(const int v[3], const uint axis) {
  return axis == 0 ? v[0] : (axis == 1 ? v[1] : v[2]);
}

// Returns true if a cell inside `region.all` belongs to the region.
static inline bool in_region(const ClpvRegion* region, const int x, const int y, const int z) {
  if (region->boxes == 1) return true;
#define CLPV_IN_BOX(b)                                                                           \
  ((region->boxes > b) & (x >= region->box[b].low[0]) & (x <= region->box[b].high[0]) &          \
   (y >= region->box[b].low[1]) & (y <= region->box[b].high[1]) & (z >= region->box[b].low[2]) & \
   (z <= region->box[b].high[2]))
  return CLPV_IN_BOX(0) | CLPV_IN_BOX(1) | CLPV_IN_BOX(2) | CLPV_IN_BOX(3) | CLPV_IN_BOX(4) |
         CLPV_IN_BOX(5) | CLPV_IN_BOX(6) | CLPV_IN_BOX(7);
#undef CLPV_IN_BOX
}
// Number of a cell among the cells^3 of a cascade; no_cell outside the region. u, v, w: the cell
// along u, v and the axis, from the base; not an int3, whose components Intel's CPU runtime 2026.22
// permutes in work-items of large kernels.
__constant const uint no_cell = 0xffffffffu;
static inline uint find_region_cell(const ClpvRegion* region, const uint axis, const int u,
                                    const int v, const int w, const int cells) {
  int at[3];
  at[(axis + 1) % 3] = u;
  at[(axis + 2) % 3] = v;
  at[axis] = w;
  const int x = at[0] - region->first[0], y = at[1] - region->first[1],
            z = at[2] - region->first[2];
  return in_region(region, x, y, z) ? (uint)((z * cells + y) * cells + x) : no_cell;
}
#if CLPV_REGION_BOXES != 8
#error "in_region tests eight boxes"
#endif

// Number of this work-item's triangle; triangle_count or more for none. Kernels that voxelise
// launch CLPV_CLUSTER work-items for each of `cluster_count` entries of `clusters` from
// `first_cluster` on.
static inline uint triangle_number(__global const uint* clusters, const uint first_cluster,
                                   const uint cluster_count, const uint triangle_count) {
  const uint item = (uint)get_global_id(0), cluster = item / CLPV_CLUSTER;
  if (cluster >= cluster_count) return triangle_count;
  return clusters[first_cluster + cluster] * CLPV_CLUSTER + item % CLPV_CLUSTER;
}
