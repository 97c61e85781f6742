// SPDX-License-Identifier: MIT
// W cells of layouts in which W samples of a coefficient are adjacent, for buffer.h. Such a layout
// defines NAME_samples(volume, at, x): the samples of a coefficient at x to x + W - 1, from index
// `at` on.
CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, load_cells)(CLPV_BUFFER_IN volume,
                                                                 const int at, const int x) {
  CLPV_VOLUME_CELL cell;
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i)
    cell.c[i] = CLPV_PASTE(CLPV_VOLUME, samples)(volume, at + i * CLPV_NEXT, x);
  return cell;
}

CLPV_INLINE void CLPV_PASTE(CLPV_VOLUME, store_cells)(CLPV_BUFFER_OUT volume, const int at,
                                                      const CLPV_VOLUME_CELL cell) {
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) write_numbers(volume, at + i * CLPV_NEXT, cell.c[i]);
}
