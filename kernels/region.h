// SPDX-License-Identifier: MIT
// The cells that are made anew (shared/region.h), and the triangles that may leave something in them.
#ifndef CLPV_REGION_H
#define CLPV_REGION_H

#include "shared/mesh.h"
#include "shared/region.h"

// Whether a cell inside `region.all` is one of them.
static inline bool clpv_in_region(const ClpvRegion* region, const int x, const int y, const int z) {
  if (region->boxes == 1) return true;
  for (uint b = 0; b < region->boxes; ++b) {
    const ClpvBox* box = region->box + b;
    if (x >= box->low[0] && x <= box->high[0] && y >= box->low[1] && y <= box->high[1] && z >= box->low[2] &&
        z <= box->high[2])
      return true;
  }
  return false;
}

// The arguments of kernels that go through triangles, an item each, a group a run: those of `runs` from `first_run` on;
// `triangle_count`: of the scene.
#define CLPV_TRIANGLES                                                                                      \
  __global const uint *runs, const uint first_run, const uint run_count, const uint triangle_count,         \
      __global const ClpvVertex *vertices, __global const ClpvTriangle *triangles, __global const ClpvMaterial *materials

// The number of the item's triangle; triangle_count or more: it has none.
#define CLPV_TRIANGLE_NUMBER                                                                                         \
  (get_global_id(0) / CLPV_RUN < run_count                                                                           \
       ? runs[first_run + get_global_id(0) / CLPV_RUN] * CLPV_RUN + (uint)get_global_id(0) % CLPV_RUN                \
       : triangle_count)

#endif
