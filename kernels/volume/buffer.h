// SPDX-License-Identifier: MIT
// Load and store of volumes in buffers, for soa.h, aos.h and tiled.h alike. Part of the template instance.h.
//
// A layout defines
//   NAME_address(channel, x, y, z)            of coefficient 0
//   CLPV_NEXT, CLPV_LANE                      from there to the next coefficient; to the cell right of it
//   CLPV_BEFORE_LOAD, CLPV_LOAD_LANES(i)      coefficient i of 8 cells of `volume`, the first at x, whose address is `at`;
//                                             before the first, some statements
//   CLPV_BEFORE_STORE, CLPV_STORE_LANES(i), CLPV_AFTER_STORE     statements that store `cell` there, all inside the grid
CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, load)(CLPV_BUFFER_IN volume, const int channel, const int x,
                                                           const int y, const int z) {
  const int at = CLPV_PASTE(CLPV_VOLUME, address)(channel, x, y, z);
  CLPV_VOLUME_CELL cell;
#if CLPV_LANES == 8
  CLPV_BEFORE_LOAD
#define CLPV_DO(i) cell.c##i = CLPV_LOAD_LANES(i);
#else
#define CLPV_DO(i) cell.c##i = CLPV_READ(volume, at + i * CLPV_NEXT);
#endif
  CLPV_VOLUME_EACH(CLPV_DO)
#undef CLPV_DO
  return cell;
}

CLPV_INLINE void CLPV_PASTE(CLPV_VOLUME, store)(CLPV_BUFFER_OUT volume, const int channel, const int x, const int y,
                                                const int z, const CLPV_VOLUME_CELL cell) {
  const int at = CLPV_PASTE(CLPV_VOLUME, address)(channel, x, y, z);
#if CLPV_LANES == 8
#if CLPV_VOLUME_N % 8  // (a dead branch would still be compiled, into a thousand instructions on PoCL)
  if (x + 8 > CLPV_VOLUME_N) {  // the row's end: what lies beyond is not this one's
    for (int lane = 0; lane < CLPV_VOLUME_N - x; ++lane) {
#define CLPV_DO(i) CLPV_WRITE(volume, at + lane * CLPV_LANE + i * CLPV_NEXT, ((const float*)&cell.c##i)[lane]);
      CLPV_VOLUME_EACH(CLPV_DO)
#undef CLPV_DO
    }
    return;
  }
#endif
  CLPV_BEFORE_STORE
  CLPV_VOLUME_EACH(CLPV_STORE_LANES)
  CLPV_AFTER_STORE
#else
#define CLPV_DO(i) CLPV_WRITE(volume, at + i * CLPV_NEXT, cell.c##i);
  CLPV_VOLUME_EACH(CLPV_DO)
#undef CLPV_DO
#endif
}

#undef CLPV_AFTER_STORE
#undef CLPV_STORE_LANES
#undef CLPV_STORE_ROW
#undef CLPV_BEFORE_STORE
#undef CLPV_LOAD_LANES
#undef CLPV_BEFORE_LOAD
#undef CLPV_LOAD_ROW
#undef CLPV_DEALT
#undef CLPV_LANE
#undef CLPV_NEXT
#undef CLPV_BLOCK
#undef CLPV_ROWS
#undef CLPV_BLOCKS
#undef CLPV_PITCH
