// SPDX-License-Identifier: MIT
// Volume layout `image`: one 3-D image of RGBA texels with four coefficients each. Part of the
// template instance.h.
//
// A single image holds all: OpenCL 1.2 guarantees 8 writable images per kernel. Groups of four
// coefficients are stacked along z and channels along y, with a texel of zeros between them; the
// sampler's border is zero as well. The host sees to it that a kernel either reads or writes an
// image.
#define CLPV_STEP \
  (CLPV_VOLUME_N + 1)  // step to the next channel, and to the next four coefficients
#define CLPV_FOURS ((CLPV_VOLUME_COUNT + 3) / 4)

CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, load)(__read_only image3d_t volume,
                                                           const int channel, const int x,
                                                           const int y, const int z) {
  float4 texels[CLPV_FOURS];
  for (int four = 0; four < CLPV_FOURS; ++four) {
    texels[four] = read_imagef(volume, nearest_sampler,
                               (int4)(x, y + channel * CLPV_STEP, z + four * CLPV_STEP, 0));
  }
  CLPV_VOLUME_CELL cell;
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) cell.c[i] = ((const float*)texels)[i];
  return cell;
}

// An image of halves stores the nearest half. Devices may round towards zero when they write
// (OpenCL 1.2, 8.3.2), which would lose light with each step.
CLPV_INLINE float4 CLPV_PASTE(CLPV_VOLUME, stored)(const float4 texel) {
#if CLPV_STORAGE_HALF
  ushort4 bits;
  vstore_half4_rte(texel, 0, (half*)&bits);
  return vload_half4(0, (const half*)&bits);
#else
  return texel;
#endif
}

CLPV_INLINE void CLPV_PASTE(CLPV_VOLUME, store)(__write_only image3d_t volume, const int channel,
                                                const int x, const int y, const int z,
                                                const CLPV_VOLUME_CELL cell) {
  float4 texels[CLPV_FOURS];
  texels[CLPV_FOURS - 1] = 0.0f;
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) ((float*)texels)[i] = cell.c[i];
  for (int four = 0; four < CLPV_FOURS; ++four) {
    write_imagef(volume, (int4)(x, y + channel * CLPV_STEP, z + four * CLPV_STEP, 0),
                 CLPV_PASTE(CLPV_VOLUME, stored)(texels[four]));
  }
}

#ifdef CLPV_FILTERED
// Trilinear sample at a point in units of samples, sample 0 at 0.0; points are clamped to the
// outermost samples. CLPV_FILTERED 1: by the device's filter, one read per four coefficients; 0:
// from eight texels.
CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, sample)(__read_only image3d_t volume,
                                                             const int channel, const float x,
                                                             const float y, const float z) {
  const float top = (float)(CLPV_VOLUME_N - 1);
  const float px = clamp(x, 0.0f, top), py = clamp(y, 0.0f, top), pz = clamp(z, 0.0f, top);
  float4 texels[CLPV_FOURS];
#if CLPV_FILTERED
  for (int four = 0; four < CLPV_FOURS; ++four) {
    texels[four] = read_imagef(volume, linear_sampler,
                               (float4)(px + 0.5f, py + (channel * CLPV_STEP + 0.5f),
                                        pz + (four * CLPV_STEP + 0.5f), 0.0f));
  }
#else
  const float fx = floor(px), fy = floor(py), fz = floor(pz);
  const float4 tx = px - fx, ty = py - fy, tz = pz - fz;
  const int ix = (int)fx, iy = (int)fy + channel * CLPV_STEP;
  for (int four = 0; four < CLPV_FOURS; ++four) {
    const int iz = (int)fz + four * CLPV_STEP;
    // At the last sample the neighbour beyond is zero and has weight 0.
    texels[four] = mix(
        mix(mix_texels(volume, ix, iy, iz, tx), mix_texels(volume, ix, iy + 1, iz, tx), ty),
        mix(mix_texels(volume, ix, iy, iz + 1, tx), mix_texels(volume, ix, iy + 1, iz + 1, tx), ty),
        tz);
  }
#endif
  CLPV_VOLUME_CELL cell;
#pragma unroll
  for (int i = 0; i < CLPV_VOLUME_COUNT; ++i) cell.c[i] = ((const float*)texels)[i];
  return cell;
}
#endif

#undef CLPV_FOURS
#undef CLPV_STEP
