// SPDX-License-Identifier: MIT
// Returns from work-items outside a grid, unless whole work-groups fill it: the branch would
// prevent vectorisation (lanes.h).
#if (CLPV_GRID + W - 1) / W % CLPV_LOCAL_X
#define CLPV_RETURN_OUTSIDE(x, y) if (x >= CLPV_GRID || y >= CLPV_GRID) return
#else
#define CLPV_RETURN_OUTSIDE(x, y)
#endif
