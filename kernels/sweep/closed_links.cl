// SPDX-License-Identifier: MIT
// Finds links that triangles close: no sample point of the cubes between two cells sees both
// centres. Finds also enclosed centres, which see fewer than CLPV_ENCLOSED of the points about them
// (docs/method.md, 'The sweep').
//
// In:   occluded  visibility of cell centres: 64 points in each cube between eight centres
//                 (voxels/visibility.cl)
//       cascade   number of the cascade whose bytes to read
// Out:  closed    a word per cube, with a border of one cube: bit pair_number(i, j)
//                 (sweep/sweep_layout.h) is set if the pair is closed, bit CLPV_ENCLOSED_BIT if
//                 the cube's lowest centre is enclosed
// A work-item tests a cube.
#include "shared/sweep.h"
#include "sweep/sweep_layout.h"

enum { CLPV_CUBE_WORDS = 8 };  // words of eight points, a byte each

// Index of the first word of a cube.
static inline size_t cube_words(const uint cascade, const int x, const int y, const int z) {
  return (((cascade * (size_t)CLPV_GRID + z) * CLPV_GRID + y) * CLPV_GRID + x) * CLPV_CUBE_WORDS;
}

// Returns true if a byte of the word is 0.
static inline bool has_zero_byte(const ulong word) {
  return ((word - 0x0101010101010101ul) & ~word & 0x8080808080808080ul) != 0;
}

// Number of points that the centre of a cell sees, in the eight cubes about it. Cubes outside the
// grid hide nothing.
static inline int count_seen(__global const ulong* occluded, const uint cascade, const int x,
                             const int y, const int z) {
  int seen = 8 * 8 * CLPV_CUBE_WORDS;
  for (int o = 0; o < CLPV_CENTRES; ++o) {
    const int i = x - 1 + (o & 1), j = y - 1 + (o >> 1 & 1), k = z - 1 + (o >> 2);
    if (min(i, min(j, k)) < 0 || max(i, max(j, k)) > CLPV_GRID - 2) continue;
    __global const ulong* points = occluded + cube_words(cascade, i, j, k);
    const ulong centre = 0x0101010101010101ul << (CLPV_CENTRES - 1 - o);
    for (int w = 0; w < CLPV_CUBE_WORDS; ++w) seen -= (int)popcount(points[w] & centre);
  }
  return seen;
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
  const size_t cube = cube_words(cascade, x, y, z);
  ulong points[CLPV_CUBE_WORDS], any = 0;
#pragma unroll
  for (int w = 0; w < CLPV_CUBE_WORDS; ++w) {
    points[w] = occluded[cube + w];
    any |= points[w];
  }
  uint bits = 0;
  if (any != 0) {
    for (int i = 0; i < CLPV_CENTRES - 1; ++i) {
      for (int j = i + 1; j < CLPV_CENTRES; ++j)
        if (closed_pair(points, i, j)) bits |= 1u << pair_number(i, j);
    }
  }
  if (count_seen(occluded, cascade, x, y, z) < CLPV_ENCLOSED) bits |= 1u << CLPV_ENCLOSED_BIT;
  closed[bordered_index(z, y, x)] = bits;
}
