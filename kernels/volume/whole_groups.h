// SPDX-License-Identifier: MIT
// Leaving work-items outside a grid idle. Not where whole work-groups fill the grid: the branch would keep work-items
// from being vectorised (lanes.h).
#if (CLPV_GRID + CLPV_LANES - 1) / CLPV_LANES % CLPV_LOCAL_X
#define CLPV_RETURN_OUTSIDE(x, y) if (x >= CLPV_GRID || y >= CLPV_GRID) return
#else
#define CLPV_RETURN_OUTSIDE(x, y)
#endif
