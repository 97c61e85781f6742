// SPDX-License-Identifier: MIT
// What is known of the triangles in a corner's cell, as kernels/blockers.cl and blocked_areas.cl see it.
#ifndef CLPV_SHARED_BLOCKERS_H
#define CLPV_SHARED_BLOCKERS_H

// Words of a corner: two of samples covered, across x, y and z.
#define CLPV_BLOCK_WORDS 6

// And of a cascade, which has a corner more than cells along each axis.
#define CLPV_BLOCK_MASKS ((CLPV_GRID + 1) * (CLPV_GRID + 1) * (CLPV_GRID + 1) * CLPV_BLOCK_WORDS)

#endif
