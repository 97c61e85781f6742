// SPDX-License-Identifier: MIT
// Load and store of volumes in buffers, for the layouts soa.h, aos.h and tiled.h. Part of the template instance.h.
//
// A layout defines
//   NAME_address(channel, x, y, z)            index of coefficient 0
//   CLPV_NEXT, CLPV_LANE                      steps to the next coefficient, and to the next cell along x
//   CLPV_BEFORE_LOAD, CLPV_LOAD_LANES(i)      statements before a load; coefficient i of 8 cells of `volume` from index
//                                             `at` on
//   CLPV_BEFORE_STORE, CLPV_STORE_LANES(i), CLPV_AFTER_STORE     statements that store 8 cells of `cell`, all inside
//                                                                the grid
CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, load)(CLPV_BUFFER_IN volume, const int channel, const int x,
                                                           const int y, const int z) {
  const int at = CLPV_PASTE(CLPV_VOLUME, address)(channel, x, y, z);
  CLPV_VOLUME_CELL cell;
#if W == 8
  CLPV_BEFORE_LOAD
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) cell.c[i] = CLPV_LOAD_LANES(i);
#else
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) cell.c[i] = CLPV_READ(volume, at + i * CLPV_NEXT);
#endif
  return cell;
}

CLPV_INLINE void CLPV_PASTE(CLPV_VOLUME, store)(CLPV_BUFFER_OUT volume, const int channel, const int x, const int y,
                                                const int z, const CLPV_VOLUME_CELL cell) {
  const int at = CLPV_PASTE(CLPV_VOLUME, address)(channel, x, y, z);
#if W == 8
#if CLPV_VOLUME_N % 8  // PoCL compiles even a dead branch, to a thousand instructions
  if (x + 8 > CLPV_VOLUME_N) {  // end of the row: lanes beyond belong to the next one
    for (int lane = 0; lane < CLPV_VOLUME_N - x; ++lane) {
#pragma unroll
      for (int i = 0; i < CLPV_VOLUME_COUNT; ++i)
        CLPV_WRITE(volume, at + lane * CLPV_LANE + i * CLPV_NEXT, ((const float*)&cell.c[i])[lane]);
    }
    return;
  }
#endif
  CLPV_BEFORE_STORE
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) CLPV_STORE_LANES(i)
  CLPV_AFTER_STORE
#else
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) CLPV_WRITE(volume, at + i * CLPV_NEXT, cell.c[i]);
#endif
}

#undef CLPV_AFTER_STORE
#undef CLPV_STORE_LANES
#undef CLPV_BEFORE_STORE
#undef CLPV_LOAD_LANES
#undef CLPV_BEFORE_LOAD
#undef CLPV_TRANSPOSED
#undef CLPV_LANE
#undef CLPV_NEXT
#undef CLPV_BLOCK
#undef CLPV_ROWS
#undef CLPV_BLOCKS
#undef CLPV_PITCH
