// Volume layout `aos`: array of structures. The coefficients of a sample lie side by side, samples by channel, z, y, x
// with a border of one zero sample all round. Part of the template instance.h; buffer.h makes the functions.
#define CLPV_PITCH (CLPV_VOLUME_N + 2)
#define CLPV_NEXT 1                  // from a coefficient to the next one
#define CLPV_LANE CLPV_VOLUME_COUNT  // from a cell to its right neighbour

CLPV_INLINE int CLPV_PASTE(CLPV_VOLUME, address)(const int channel, const int x, const int y, const int z) {
  return (((channel * CLPV_PITCH + (z + 1)) * CLPV_PITCH + (y + 1)) * CLPV_PITCH + (x + 1)) * CLPV_VOLUME_COUNT;
}

#define CLPV_LOAD_LANES(volume, at, x)                                                                  \
  ((float8)(CLPV_READ(volume, at), CLPV_READ(volume, (at) + CLPV_LANE),                                 \
            CLPV_READ(volume, (at) + 2 * CLPV_LANE), CLPV_READ(volume, (at) + 3 * CLPV_LANE),           \
            CLPV_READ(volume, (at) + 4 * CLPV_LANE), CLPV_READ(volume, (at) + 5 * CLPV_LANE),           \
            CLPV_READ(volume, (at) + 6 * CLPV_LANE), CLPV_READ(volume, (at) + 7 * CLPV_LANE)))
#define CLPV_STORE_LANES(volume, at, value)             \
  CLPV_WRITE(volume, at, (value).s0);                   \
  CLPV_WRITE(volume, (at) + CLPV_LANE, (value).s1);     \
  CLPV_WRITE(volume, (at) + 2 * CLPV_LANE, (value).s2); \
  CLPV_WRITE(volume, (at) + 3 * CLPV_LANE, (value).s3); \
  CLPV_WRITE(volume, (at) + 4 * CLPV_LANE, (value).s4); \
  CLPV_WRITE(volume, (at) + 5 * CLPV_LANE, (value).s5); \
  CLPV_WRITE(volume, (at) + 6 * CLPV_LANE, (value).s6); \
  CLPV_WRITE(volume, (at) + 7 * CLPV_LANE, (value).s7)
