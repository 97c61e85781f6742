// SPDX-License-Identifier: MIT
// Volume layout `tiled`: blocks of 8 samples along x by all coefficients, with the 8 samples of a
// coefficient adjacent. A row starts with a block of zeros, which also ends the previous row; rows
// of zeros form the rest of the border. Part of the template instance.h; buffer.h defines the
// functions.
#define CLPV_BLOCK (8 * CLPV_VOLUME_COUNT)
#define CLPV_NEXT 8  // step to the next coefficient
#define CLPV_LANE 1  // step to the next cell along x in the same block

CLPV_INLINE int CLPV_PASTE(CLPV_VOLUME, address)(const int channel, const int x, const int y,
                                                 const int z) {
  const int rows = CLPV_VOLUME_N + 2, row_blocks = (CLPV_VOLUME_N + 7) / 8 + 1;
  const int row = (channel * rows + (z + 1)) * rows + (y + 1);
  return (row * row_blocks + 1 + (x >> 3)) * CLPV_BLOCK + (x & 7);
}

#if W == 8
// Most callers have x a multiple of 8, or 1 less or more, which compilers derive from literal
// offsets.
CLPV_INLINE float8 CLPV_PASTE(CLPV_VOLUME, samples)(CLPV_BUFFER_IN volume, const int at,
                                                   const int x) {
  const int block = at - (x & 7);
  const float8 row = read_eight(volume, block);
  if ((x & 7) == 0) return row;
  const float8 next = read_eight(volume, block + CLPV_BLOCK);
  // Element by element, as in gather_packed.h.
  if ((x & 7) == 1)
    return (float8)(row.s1, row.s2, row.s3, row.s4, row.s5, row.s6, row.s7, next.s0);
  if ((x & 7) == 7)
    return (float8)(row.s7, next.s0, next.s1, next.s2, next.s3, next.s4, next.s5, next.s6);
  const float8 both[2] = {row, next};
  return vload8(0, (const float*)both + (x & 7));
}
#else
CLPV_INLINE float CLPV_PASTE(CLPV_VOLUME, samples)(CLPV_BUFFER_IN volume, const int at,
                                                  const int x) {
  return read_number(volume, at);
}
#endif
#include "volume/adjacent.h"
