// SPDX-License-Identifier: MIT
// Tests whether a work-item is outside the grid. Where whole work-groups fill the grid, none is,
// and the test is constant: a branch would prevent vectorisation (lanes.h). From the host:
// CLPV_LOCAL_X, work-items of a group along x.
#pragma once

#include "lanes.h"

CLPV_INLINE bool outside_grid(const int x, const int y) {
  const bool whole = (CLPV_GRID + W - 1) / W % CLPV_LOCAL_X == 0;
  return !whole && (x >= CLPV_GRID || y >= CLPV_GRID);
}
