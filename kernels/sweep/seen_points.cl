// SPDX-License-Identifier: MIT
// Counts the sample points between cells that triangles hide from the cells' centres. A link
// transmits the share of points that see both of its ends (sweep/sweep_links.cl).
//
// In:   occluded  visibility of cell centres: 64 points in each cube between eight centres
//                 (voxels/visibility.cl)
//       cascade   number of the cascade whose bytes to read
// Out:  hidden    CLPV_HIDDEN_WORDS volumes of a word per cube, with a border of one cube: byte
//                 pair_number(i, j) (sweep/sweep_layout.h) of a cube has the points that centre i
//                 or j does not see, byte centre_number(i) those that i does not see
// In a cube outside the grid centres see what those at the border see, so that walls which cross
// the border close links there, too. A work-item counts in a cube.
#include "shared/sweep.h"
#include "sweep/sweep_layout.h"

enum { CLPV_CUBE_WORDS = 8 };  // words of eight points, a byte each

// Number of points that centre i or j does not see.
static inline uint count_hidden(const ulong* points, const int i, const int j) {
  uint count = 0;
#pragma unroll
  for (int w = 0; w < CLPV_CUBE_WORDS; ++w)
    count += (uint)popcount((points[w] >> i | points[w] >> j) & 0x0101010101010101ul);
  return count;
}

__kernel void count_hidden_points(__global const ulong* occluded, const uint cascade,
                                  __global uint* hidden) {
  const int x = (int)get_global_id(0) - 1, y = (int)get_global_id(1) - 1,
            z = (int)get_global_id(2) - 1, last = max(CLPV_GRID - 2, 0);
  if (x >= CLPV_GRID) return;
  const int i = clamp(x, 0, last), j = clamp(y, 0, last), k = clamp(z, 0, last);
  // Bits of centres along axes across which the cube lies outside, and those of its inner centres.
  const int outside = (i != x) | (j != y) << 1 | (k != z) << 2,
            inner = (i < x) | (j < y) << 1 | (k < z) << 2;
  const size_t cube = ((cascade * (size_t)CLPV_GRID + k) * CLPV_GRID + j) * CLPV_GRID + i;
  ulong points[CLPV_CUBE_WORDS];
#pragma unroll
  for (int w = 0; w < CLPV_CUBE_WORDS; ++w) points[w] = occluded[cube * CLPV_CUBE_WORDS + w];
  uint words[CLPV_HIDDEN_WORDS];
  for (int w = 0; w < CLPV_HIDDEN_WORDS; ++w) words[w] = 0;
  for (int a = 0; a < CLPV_CENTRES; ++a) {
    for (int b = a; b < CLPV_CENTRES; ++b) {
      const int number = a == b ? centre_number(a) : pair_number(a, b);
      const uint count =
          count_hidden(points, (a & ~outside) | inner, (b & ~outside) | inner);
      words[number / 4] |= count << 8 * (number % 4);
    }
  }
  for (int w = 0; w < CLPV_HIDDEN_WORDS; ++w)
    hidden[w * CLPV_BORDERED_VOLUME + bordered_index(z, y, x)] = words[w];
}
