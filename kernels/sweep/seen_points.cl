// SPDX-License-Identifier: MIT
// Counts the sample points between cells that triangles hide from the cells' centres. A link
// transmits the share of points that see both of its ends (sweep/sweep_links.cl).
//
// In:   occluded  visibility of cell centres: 64 points in each cube between eight centres
//                 (voxels/visibility.cl)
//       cascade   number of the cascade whose bytes to read
// Out:  hidden    CLPV_HIDDEN_WORDS volumes of a word per cube, with a border of one cube, 0 in
//                 it: byte pair_number(i, j) (sweep/sweep_layout.h) of a cube has the points that
//                 centre i or j does not see, byte centre_number(i) those that i does not see
// A work-item counts in a cube.
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
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  if (x >= CLPV_GRID) return;
  const size_t cube = ((cascade * (size_t)CLPV_GRID + z) * CLPV_GRID + y) * CLPV_GRID + x;
  ulong points[CLPV_CUBE_WORDS], any = 0;
#pragma unroll
  for (int w = 0; w < CLPV_CUBE_WORDS; ++w) {
    points[w] = occluded[cube * CLPV_CUBE_WORDS + w];
    any |= points[w];
  }
  uint words[CLPV_HIDDEN_WORDS];
  for (int w = 0; w < CLPV_HIDDEN_WORDS; ++w) words[w] = 0;
  for (int i = 0; i < CLPV_CENTRES && any != 0; ++i) {
    for (int j = i; j < CLPV_CENTRES; ++j) {
      const int number = i == j ? centre_number(i) : pair_number(i, j);
      words[number / 4] |= count_hidden(points, i, j) << 8 * (number % 4);
    }
  }
  for (int w = 0; w < CLPV_HIDDEN_WORDS; ++w)
    hidden[w * CLPV_BORDERED_VOLUME + bordered_index(z, y, x)] = words[w];
}
