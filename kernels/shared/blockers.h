// SPDX-License-Identifier: MIT
// Sizes of the blocker masks: blockers.cl writes them, blocked_areas.cl reads them.
#pragma once

// uint32 words of a corner: 64 coverage bits (two words) each across x, y and z.
enum { CLPV_BLOCKER_WORDS = 6 };

// Words of a cascade, which has one corner more than cells along each axis.
#define CLPV_BLOCKER_MASKS \
  ((CLPV_GRID + 1) * (CLPV_GRID + 1) * (CLPV_GRID + 1) * CLPV_BLOCKER_WORDS)
