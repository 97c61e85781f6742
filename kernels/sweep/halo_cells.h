// SPDX-License-Identifier: MIT
// Stores the halo of a sweep cell by cell, with one lane.
#pragma once

#include "sweep/sweep_cell.h"

// Stores a cell in each face of the halo that it belongs to.
CLPV_INLINE void store_halo_cell(const BinSweep* s, const ClpvSweepHalo halo, const int ordinate,
                                 const int3 cell, const float d) {
  const ClpvSweepBin bin = s->bin;
  const int p = cell.z - halo_first(halo, bin.plane_axis),
            r = cell.y - halo_first(halo, bin.row_axis),
            c = cell.x - halo_first(halo, bin.column_axis);
  if (p < 0 || r < 0 || c < 0 || p >= halo.side || r >= halo.side || c >= halo.side) return;
  int layer = cell.z - halo_layer(halo, bin.plane_axis, bin.plane_sign);
  if (layer == 0 || layer == 1)
    write_number(s->halo_light, halo_index(halo, ordinate, CLPV_BORDER_PLANE, layer, r, c), d);
  layer = cell.y - halo_layer(halo, bin.row_axis, bin.row_sign);
  if (layer == 0 || layer == 1)
    write_number(s->halo_light, halo_index(halo, ordinate, CLPV_BORDER_ROW, layer, p, c), d);
  layer = cell.x - halo_layer(halo, bin.column_axis, bin.column_sign);
  if (layer == 0 || layer == 1)
    write_number(s->halo_light, halo_index(halo, ordinate, CLPV_BORDER_COLUMN, layer, p, r), d);
}
