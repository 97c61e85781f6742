// SPDX-License-Identifier: MIT
// Load and store of volumes in buffers, for the layouts soa.h, aos.h and tiled.h. Part of the
// template instance.h.
//
// A layout defines
//   NAME_address(channel, x, y, z)     index of coefficient 0
//   CLPV_NEXT, CLPV_LANE               steps to the next coefficient, and to the next cell along x
//   NAME_load_cells(volume, at, x)     the W cells from x on, from index `at` on
//   NAME_store_cells(volume, at, cell) stores them; all are inside the grid
CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, load)(CLPV_BUFFER_IN volume, const int channel,
                                                           const int x, const int y, const int z) {
  const int at = CLPV_PASTE(CLPV_VOLUME, address)(channel, x, y, z);
  return CLPV_PASTE(CLPV_VOLUME, load_cells)(volume, at, x);
}

CLPV_INLINE void CLPV_PASTE(CLPV_VOLUME, store)(CLPV_BUFFER_OUT volume, const int channel,
                                                const int x, const int y, const int z,
                                                const CLPV_VOLUME_CELL cell) {
  const int at = CLPV_PASTE(CLPV_VOLUME, address)(channel, x, y, z);
#if CLPV_VOLUME_N % W  // PoCL compiles even a dead branch, to a thousand instructions
  if (x + W > CLPV_VOLUME_N) {  // end of the row: lanes beyond belong to the next one
    for (int lane = 0; lane < CLPV_VOLUME_N - x; ++lane) {
#pragma unroll
      for (int i = 0; i < CLPV_VOLUME_COUNT; ++i)
        write_number(volume, at + lane * CLPV_LANE + i * CLPV_NEXT,
                     ((const float*)&cell.c[i])[lane]);
    }
    return;
  }
#endif
  CLPV_PASTE(CLPV_VOLUME, store_cells)(volume, at, cell);
}

#undef CLPV_LANE
#undef CLPV_NEXT
#undef CLPV_BLOCK
#undef CLPV_ROWS
#undef CLPV_PITCH
