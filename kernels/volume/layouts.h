// SPDX-License-Identifier: MIT
// Memory layouts of volumes, and what every instance of the template instance.h needs once.
//
// Literals: CLPV_LAYOUT, one of the four names below, 0 if undefined; CLPV_STORAGE_HALF 1: numbers
// of 16 bits, with arithmetic in single precision.
#pragma once

#define CLPV_SOA 1
#define CLPV_AOS 2
#define CLPV_TILED 3
#define CLPV_IMAGE 4

// Joins two names: light, load -> light_load.
#define CLPV_PASTE2(a, b) a##_##b
#define CLPV_PASTE(a, b) CLPV_PASTE2(a, b)

// Types of kernel parameters that read and write volumes.
#if CLPV_LAYOUT == CLPV_IMAGE
#pragma OPENCL EXTENSION cl_khr_3d_image_writes : enable
#define CLPV_VOLUME_IN __read_only image3d_t
#define CLPV_VOLUME_OUT __write_only image3d_t
__constant sampler_t nearest_sampler =
    CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_CLAMP | CLK_FILTER_NEAREST;
#ifdef CLPV_FILTERED
__constant sampler_t linear_sampler =
    CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_CLAMP | CLK_FILTER_LINEAR;
#endif

// (1 - t) texel x + t texel x + 1
CLPV_INLINE float4 mix_texels(__read_only image3d_t volume, const int x, const int y, const int z,
                              const float4 t) {
  return mix(read_imagef(volume, nearest_sampler, (int4)(x, y, z, 0)),
             read_imagef(volume, nearest_sampler, (int4)(x + 1, y, z, 0)), t);
}
#else
#include "volume/numbers.h"
#define CLPV_VOLUME_IN CLPV_BUFFER_IN
#define CLPV_VOLUME_OUT CLPV_BUFFER_OUT
#endif
