// SPDX-License-Identifier: MIT
// Finds links that triangles close: no sample point of the cubes between two cells sees both
// centres. Such links transmit nothing (docs/method.md, 'The sweep').
//
// In:   occluded  visibility of cell centres: 64 points in each cube between eight centres
//                 (voxels/visibility.cl)
//       cascade   number of the cascade whose bytes to read
// Out:  closed    a word per cube, with a border of one cube: bit CLPV_PAIR(i, j)
//                 (sweep/centre_pairs.h) is set if the pair is closed
// A work-item tests a cube.
#include "shared/sweep.h"
#include "sweep/centre_pairs.h"
#include "sweep/sweep_layout.h"

enum { CLPV_CUBE_WORDS = 8 };  // of eight points, a byte each

// Returns true if a byte of the word is 0.
static inline bool has_zero_byte(const ulong word) {
  return ((word - 0x0101010101010101ul) & ~word & 0x8080808080808080ul) != 0;
}

// Returns true if no point sees both centres.
static inline bool closed_pair(const ulong* points, const int i, const int j) {
  const ulong both = ((1ul << i) | (1ul << j)) * 0x0101010101010101ul;
  bool open = false;
#pragma unroll
  for (int w = 0; w < CLPV_CUBE_WORDS; ++w) open = open || has_zero_byte(points[w] & both);
  return !open;
}

__kernel void find_closed_links(__global const ulong* occluded, const uint cascade,
                                __global uint* closed) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
  if (x >= CLPV_GRID) return;
  const size_t cube = ((cascade * (size_t)CLPV_GRID + z) * CLPV_GRID + y) * CLPV_GRID + x;
  ulong points[CLPV_CUBE_WORDS], any = 0;
#pragma unroll
  for (int w = 0; w < CLPV_CUBE_WORDS; ++w) {
    points[w] = occluded[cube * CLPV_CUBE_WORDS + w];
    any |= points[w];
  }
  uint bits = 0;
  if (any != 0) {
    for (int i = 0; i < CLPV_CENTRES - 1; ++i) {
      for (int j = i + 1; j < CLPV_CENTRES; ++j)
        if (closed_pair(points, i, j)) bits |= 1u << CLPV_PAIR(i, j);
    }
  }
  closed[bordered_index(z, y, x)] = bits;
}
