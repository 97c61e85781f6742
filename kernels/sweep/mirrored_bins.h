// SPDX-License-Identifier: MIT
// Bins that mirror one another, as sums and differences: projection and scattering are symmetric
// under mirroring, so most of their matrix entries are then 0.
//
// The eight bins 8a, ..., 8a + 7 lie about axis a, and differ in the signs of their components:
// bits 0, 1 and 2 of the index are the bits of axes a + 1, a + 2 and a (modulo 3).
#pragma once

#include "sweep/sweep_tiles.h"

// Replaces the bins of each axis by their sums and differences: number 8a + k is the sum over j of
// (-1)^|j & k| L_(8a + j), |n| the number of bits (a Walsh-Hadamard transform).
CLPV_INLINE Bins fold_bins(const Bins bins) {
  Bins r = bins;
#pragma unroll
  for (int bit = 1; bit < CLPV_AXIS_BINS; bit *= 2) {
#pragma unroll
    for (int b = 0; b < CLPV_SWEEP_BINS; ++b) {
      if (b & bit) continue;
      const realW low = r.c[b], high = r.c[b + bit];
      r.c[b] = low + high;
      r.c[b + bit] = low - high;
    }
  }
  return r;
}

// Index, among an axis's eight sums, of the sum that changes sign when an axis in `odd` (bits 0, 1,
// 2: x, y, z) is mirrored, and only then.
CLPV_INLINE int folded_number(const int axis, const int odd) {
  return ((odd | odd << 3) >> (axis + 1) % 3) & 7;
}

// Sign of bin j of an axis in the axis's sum k: (-1)^|j & k|.
CLPV_INLINE float folded_sign(const int j, const int k) {
  const int both = j & k;
  return (both ^ both >> 1 ^ both >> 2) & 1 ? -1.0f : 1.0f;
}
