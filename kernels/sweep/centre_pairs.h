// SPDX-License-Identifier: MIT
// Pairs of the eight cell centres at the corners of a cube: closed_links.cl writes a bit for each,
// sweep_links.cl reads them.
#pragma once

enum {
  CLPV_CENTRES = 8,        // centre i is offset by (i & 1, i >> 1 & 1, i >> 2)
  CLPV_ENCLOSED_BIT = 28,  // after the pairs
};

// Number of the pair of centres i < j: 0 to 27.
static inline int pair_number(const int i, const int j) { return i * (13 - i) / 2 + j - 1; }
