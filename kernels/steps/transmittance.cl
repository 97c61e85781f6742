// SPDX-License-Identifier: MIT
// Computes the transmittance of each link into a cell from the blockers at its corners.
//
//   T = 1 - clamp(B, 0, 1),   B the blocking potential along the link, a mean over the corners of the face that it
//                             passes
//
// docs/method.md, 'Blockers'. Kaplanyan and Dachsbacher 2010, 'Cascaded light propagation volumes'.
//
// In:   blockers       geometry volume, samples at the cells' corners
// Out:  transmittance  T in [0, 1] of each cell and link
// From the host (host/codegen/transmittance_source.cpp): CLPV_TRANSMITTANCE, which declares `links`. A work-item
// computes W cells of a row.
#include "volume/coefficients.h"
#include "volume/geometry.h"
#include "volume/transmittance.h"
#include "volume/whole_groups.h"

#define CLPV_LOAD_CORNER(i) \
  const Coefficients g##i = geometry_load(blockers, 0, x + (i & 1), y + ((i >> 1) & 1), z + (i >> 2));

__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, 1, 1))) void transmit(
    CLPV_VOLUME_IN blockers, CLPV_VOLUME_OUT transmittance) {
  const int x = W * (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  CLPV_RETURN_OUTSIDE(x, y);
  CLPV_LOAD_CORNER(0) CLPV_LOAD_CORNER(1) CLPV_LOAD_CORNER(2) CLPV_LOAD_CORNER(3)
  CLPV_LOAD_CORNER(4) CLPV_LOAD_CORNER(5) CLPV_LOAD_CORNER(6) CLPV_LOAD_CORNER(7)
  CLPV_TRANSMITTANCE
  transmittance_store(transmittance, 0, x, y, z, links);
}
