// SPDX-License-Identifier: MIT
// Volume layout `soa`, structure of arrays: a block of samples for each channel and coefficient,
// with a border of one zero sample on every side. Part of the template instance.h; buffer.h defines
// the functions.
#define CLPV_ROWS (CLPV_VOLUME_N + 2)
#define CLPV_PITCH ((CLPV_VOLUME_N + 7) / 8 * 8 + 2)  // samples of a row, padded for eight lanes
#define CLPV_NEXT (CLPV_PITCH * CLPV_ROWS * CLPV_ROWS)  // step to the next coefficient
#define CLPV_LANE 1                                       // step to the next cell along x

CLPV_INLINE int CLPV_PASTE(CLPV_VOLUME, address)(const int channel, const int x, const int y,
                                                 const int z) {
  return channel * (CLPV_VOLUME_COUNT * CLPV_NEXT) + ((z + 1) * CLPV_ROWS + (y + 1)) * CLPV_PITCH +
         (x + 1);
}

CLPV_INLINE realW CLPV_PASTE(CLPV_VOLUME, samples)(CLPV_BUFFER_IN volume, const int at,
                                                  const int x) {
  return read_numbers(volume, at);
}
#include "volume/adjacent.h"
