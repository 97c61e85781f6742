// SPDX-License-Identifier: MIT
// Volume layout `soa`: structure of arrays. One plane of samples a channel and coefficient; every plane has a border
// of one zero sample all round. Part of the template instance.h; buffer.h makes the functions.
#define CLPV_ROWS (CLPV_VOLUME_N + 2)
#define CLPV_PITCH ((CLPV_VOLUME_N + 7) / 8 * 8 + 2)  // of a row: eight lanes never reach into the next one
#define CLPV_NEXT (CLPV_PITCH * CLPV_ROWS * CLPV_ROWS)  // from a coefficient to the next one
#define CLPV_LANE 1                                       // from a cell to its right neighbour

CLPV_INLINE int CLPV_PASTE(CLPV_VOLUME, address)(const int channel, const int x, const int y, const int z) {
  return channel * (CLPV_VOLUME_COUNT * CLPV_NEXT) + ((z + 1) * CLPV_ROWS + (y + 1)) * CLPV_PITCH + (x + 1);
}

#define CLPV_BEFORE_LOAD
#define CLPV_LOAD_LANES(i) CLPV_READ_ROW(volume, at + i * CLPV_NEXT)
#define CLPV_BEFORE_STORE
#define CLPV_STORE_LANES(i) CLPV_WRITE_ROW(volume, at + i * CLPV_NEXT, cell.c##i);
#define CLPV_AFTER_STORE
