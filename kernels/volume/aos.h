// SPDX-License-Identifier: MIT
// Volume layout `aos`, array of structures: coefficients of a sample are adjacent; samples are ordered by channel, z,
// y, x, with a border of one zero sample on every side. Part of the template instance.h; buffer.h defines the
// functions.
#define CLPV_ROWS (CLPV_VOLUME_N + 2)
#define CLPV_PITCH ((CLPV_VOLUME_N + 7) / 8 * 8 + 2)  // samples of a row, padded for eight lanes
#define CLPV_NEXT 1                  // step to the next coefficient
#define CLPV_LANE CLPV_VOLUME_COUNT  // step to the next cell along x

CLPV_INLINE int CLPV_PASTE(CLPV_VOLUME, address)(const int channel, const int x, const int y, const int z) {
  return (((channel * CLPV_ROWS + (z + 1)) * CLPV_ROWS + (y + 1)) * CLPV_PITCH + (x + 1)) * CLPV_VOLUME_COUNT;
}

// Eight samples are loaded as CLPV_VOLUME_COUNT vectors of eight numbers, then transposed. PoCL 7.1 compiles
// a loop of loads wrongly, and PoCL 3.1 slowly.
#define CLPV_TRANSPOSED(from, i)                                                                         \
  ((float8)((from)[i], (from)[CLPV_LANE + i], (from)[2 * CLPV_LANE + i], (from)[3 * CLPV_LANE + i], \
            (from)[4 * CLPV_LANE + i], (from)[5 * CLPV_LANE + i], (from)[6 * CLPV_LANE + i],        \
            (from)[7 * CLPV_LANE + i]))
#define CLPV_BEFORE_LOAD          \
  float8 rows[CLPV_VOLUME_COUNT]; \
  _Pragma("unroll")               \
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) rows[i] = CLPV_READ_ROW(volume, at + 8 * i);
#define CLPV_LOAD_LANES(i) CLPV_TRANSPOSED((const float*)rows, i)

#define CLPV_STORE_LANES(i)                                                              \
  for (int lane = 0; lane < 8; ++lane) {                                                 \
    ((float*)rows)[lane * CLPV_LANE + i] = ((const float*)&cell.c[i])[lane];             \
  }
#define CLPV_BEFORE_STORE float8 rows[CLPV_VOLUME_COUNT];
#define CLPV_AFTER_STORE \
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) CLPV_WRITE_ROW(volume, at + 8 * i, rows[i]);
