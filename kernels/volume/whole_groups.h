// SPDX-License-Identifier: MIT
// Work-items outside a grid: none where whole work-groups fill it. A branch would then prevent
// vectorisation (lanes.h), so that the test is a constant. From the host:
// CLPV_LOCAL_X, work-items of a group along x.
#pragma once

#include "lanes.h"

CLPV_INLINE bool outside_grid(const int x, const int y) {
  const bool whole = (CLPV_GRID + W - 1) / W % CLPV_LOCAL_X == 0;
  return !whole && (x >= CLPV_GRID || y >= CLPV_GRID);
}
