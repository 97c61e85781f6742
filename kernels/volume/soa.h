// Volume layout `soa`: structure of arrays. One plane of samples a channel and coefficient; every plane has a border
// of one zero sample all round, so that a neighbour outside the grid reads 0 without a test.
//
// A template: before each inclusion define, and it is undefined after,
//   CLPV_VOLUME         the name the functions below start with (light, geometry, ...)
//   CLPV_VOLUME_N       samples along each axis, a literal
//   CLPV_VOLUME_CELL    the struct of named scalars c0, c1, ... a sample and channel holds
//   CLPV_VOLUME_EACH    CLPV_VOLUME_EACH(DO) writes DO(0) DO(1) ... , one a coefficient
//   CLPV_VOLUME_COUNT   how many those are
// It defines
//   CLPV_VOLUME_IN, CLPV_VOLUME_OUT                    types of kernel parameters that read, write
//   CELL NAME_load(in, channel, x, y, z)               x, y, z in -1..n; the border is 0
//   void NAME_store(out, channel, x, y, z, cell)       x, y, z in 0..n-1
//   CELL NAME_sample(in, channel, x, y, z)             trilinear at a point in units of samples, sample 0 at 0.0;
//                                                      points beyond the outermost samples take their value
#ifndef CLPV_VOLUME_SOA_ONCE
#define CLPV_VOLUME_SOA_ONCE
#define CLPV_VOLUME_IN __global const float*
#define CLPV_VOLUME_OUT __global float*
#define CLPV_PASTE2(a, b) a##_##b
#define CLPV_PASTE(a, b) CLPV_PASTE2(a, b)
#endif

#define CLPV_PITCH (CLPV_VOLUME_N + 2)
#define CLPV_PLANE (CLPV_PITCH * CLPV_PITCH * CLPV_PITCH)

CLPV_INLINE int CLPV_PASTE(CLPV_VOLUME, address)(const int channel, const int x, const int y, const int z) {
  return channel * (CLPV_VOLUME_COUNT * CLPV_PLANE) + ((z + 1) * CLPV_PITCH + (y + 1)) * CLPV_PITCH + (x + 1);
}

CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, load)(CLPV_VOLUME_IN volume, const int channel, const int x,
                                                             const int y, const int z) {
  const int at = CLPV_PASTE(CLPV_VOLUME, address)(channel, x, y, z);
  CLPV_VOLUME_CELL cell;
#define CLPV_DO(i) cell.c##i = volume[at + i * CLPV_PLANE];
  CLPV_VOLUME_EACH(CLPV_DO)
#undef CLPV_DO
  return cell;
}

CLPV_INLINE void CLPV_PASTE(CLPV_VOLUME, store)(CLPV_VOLUME_OUT volume, const int channel, const int x, const int y,
                                                  const int z, const CLPV_VOLUME_CELL cell) {
  const int at = CLPV_PASTE(CLPV_VOLUME, address)(channel, x, y, z);
#define CLPV_DO(i) volume[at + i * CLPV_PLANE] = cell.c##i;
  CLPV_VOLUME_EACH(CLPV_DO)
#undef CLPV_DO
}

CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, sample)(CLPV_VOLUME_IN volume, const int channel, const float x,
                                                               const float y, const float z) {
  const float top = (float)(CLPV_VOLUME_N - 1);
  const float px = clamp(x, 0.0f, top), py = clamp(y, 0.0f, top), pz = clamp(z, 0.0f, top);
  const float fx = floor(px), fy = floor(py), fz = floor(pz);
  const float tx = px - fx, ty = py - fy, tz = pz - fz;
  // At the last sample the neighbour beyond is the zero border, with weight 0.
  const int at = CLPV_PASTE(CLPV_VOLUME, address)(channel, (int)fx, (int)fy, (int)fz);
  CLPV_VOLUME_CELL cell;
#define CLPV_ROW(i, dy, dz)                                                                        \
  mix(volume[at + i * CLPV_PLANE + ((dz) * CLPV_PITCH + (dy)) * CLPV_PITCH],                       \
      volume[at + i * CLPV_PLANE + ((dz) * CLPV_PITCH + (dy)) * CLPV_PITCH + 1], tx)
#define CLPV_DO(i) \
  cell.c##i = mix(mix(CLPV_ROW(i, 0, 0), CLPV_ROW(i, 1, 0), ty), mix(CLPV_ROW(i, 0, 1), CLPV_ROW(i, 1, 1), ty), tz);
  CLPV_VOLUME_EACH(CLPV_DO)
#undef CLPV_DO
#undef CLPV_ROW
  return cell;
}

#undef CLPV_PLANE
#undef CLPV_PITCH
#undef CLPV_VOLUME
#undef CLPV_VOLUME_N
#undef CLPV_VOLUME_CELL
#undef CLPV_VOLUME_EACH
#undef CLPV_VOLUME_COUNT
