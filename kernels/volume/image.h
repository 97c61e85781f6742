// Volume layout `image`: one 3-D image of RGBA texels, four coefficients each. Part of the template instance.h.
//
// One image and not one for every channel and four coefficients: OpenCL 1.2 promises but 8 images a kernel writes. Fours
// of coefficients are stacked along z and channels along y, a texel of zeros between neighbours; round the image the
// sampler's border is zero as well. An image is either read or written by a kernel: the host sees to that.
#ifndef CLPV_VOLUME_IMAGE_ONCE
#define CLPV_VOLUME_IMAGE_ONCE
#pragma OPENCL EXTENSION cl_khr_3d_image_writes : enable
#define CLPV_VOLUME_IN __read_only image3d_t
#define CLPV_VOLUME_OUT __write_only image3d_t
__constant sampler_t clpv_texels = CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_CLAMP | CLK_FILTER_NEAREST;
#endif

#define CLPV_STEP (CLPV_VOLUME_N + 1)                // from a channel, or from four coefficients, to the next
#define CLPV_FOURS ((CLPV_VOLUME_COUNT + 3) / 4)

CLPV_INLINE CLPV_VOLUME_CELL CLPV_PASTE(CLPV_VOLUME, load)(CLPV_VOLUME_IN volume, const int channel, const int x,
                                                           const int y, const int z) {
  float4 texels[CLPV_FOURS];
  for (int four = 0; four < CLPV_FOURS; ++four) {
    texels[four] = read_imagef(volume, clpv_texels, (int4)(x, y + channel * CLPV_STEP, z + four * CLPV_STEP, 0));
  }
  CLPV_VOLUME_CELL cell;
#define CLPV_DO(i) cell.c##i = ((const float*)texels)[i];
  CLPV_VOLUME_EACH(CLPV_DO)
#undef CLPV_DO
  return cell;
}

CLPV_INLINE void CLPV_PASTE(CLPV_VOLUME, store)(CLPV_VOLUME_OUT volume, const int channel, const int x, const int y,
                                                const int z, const CLPV_VOLUME_CELL cell) {
  float4 texels[CLPV_FOURS];
  texels[CLPV_FOURS - 1] = 0.0f;
#define CLPV_DO(i) ((float*)texels)[i] = cell.c##i;
  CLPV_VOLUME_EACH(CLPV_DO)
#undef CLPV_DO
  for (int four = 0; four < CLPV_FOURS; ++four) {
    write_imagef(volume, (int4)(x, y + channel * CLPV_STEP, z + four * CLPV_STEP, 0), texels[four]);
  }
}

#undef CLPV_FOURS
#undef CLPV_STEP
