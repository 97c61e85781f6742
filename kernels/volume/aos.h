// SPDX-License-Identifier: MIT
// Volume layout `aos`, array of structures: coefficients of a sample are adjacent; samples are
// ordered by channel, z, y, x, with a border of one zero sample on every side. Part of the template
// instance.h; buffer.h defines the functions.
#define CLPV_NEXT 1                  // step to the next coefficient
#define CLPV_LANE CLPV_VOLUME_COUNT  // step to the next cell along x

CLPV_INLINE int CLPV_PASTE(CLPV_VOLUME, address)(const int channel, const int x, const int y,
                                                 const int z) {
  // Padded for eight lanes.
  const int rows = CLPV_VOLUME_N + 2, pitch = (CLPV_VOLUME_N + 7) / 8 * 8 + 2;
  return (((channel * rows + (z + 1)) * rows + (y + 1)) * pitch + (x + 1)) * CLPV_VOLUME_COUNT;
}

// Cells are loaded as CLPV_VOLUME_COUNT vectors of W numbers, then transposed. All loops are
// unrolled: PoCL 7.1 compiles others wrongly in an unrolled loop, and PoCL 3.1 slowly.
CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, load_cells)(CLPV_BUFFER_IN volume,
                                                                 const int at, const int x) {
  realW rows[CLPV_VOLUME_COUNT];
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) rows[i] = read_numbers(volume, at + W * i);
  CLPV_VOLUME_CELL cell;
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) {
#pragma unroll
    for (int lane = 0; lane < W; ++lane)
      ((float*)&cell.c[i])[lane] = ((const float*)rows)[lane * CLPV_LANE + i];
  }
  return cell;
}

CLPV_INLINE void CLPV_PASTE(CLPV_VOLUME, store_cells)(CLPV_BUFFER_OUT volume, const int at,
                                                      const CLPV_VOLUME_CELL cell) {
  realW rows[CLPV_VOLUME_COUNT];
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) {
#pragma unroll
    for (int lane = 0; lane < W; ++lane)
      ((float*)rows)[lane * CLPV_LANE + i] = ((const float*)&cell.c[i])[lane];
  }
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) write_numbers(volume, at + W * i, rows[i]);
}
