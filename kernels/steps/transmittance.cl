// SPDX-License-Identifier: MIT
// Computes the transmittance of each link into a cell from the blockers at its corners
// (link_transmittance.h).
//
//   T = 1 - clamp(B, 0, 1)      (docs/method.md, 'Blockers')
//
// Kaplanyan and Dachsbacher 2010, 'Cascaded light propagation volumes'.
//
// In:   blockers       geometry volume, samples at the cells' corners
// Out:  transmittance  T in [0, 1] of each cell and link
// A work-item computes W cells of a row.
#include "volume/coefficients.h"
#include "steps/link_transmittance.h"
#include "volume/transmittance.h"
#include "volume/whole_groups.h"

__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, 1, 1))) void transmit(
    CLPV_VOLUME_IN blockers, CLPV_VOLUME_OUT transmittance) {
  const int x = W * (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  if (outside_grid(x, y)) return;
  transmittance_store(transmittance, 0, x, y, z, find_transmittance(blockers, x, y, z));
}
