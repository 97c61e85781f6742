// SPDX-License-Identifier: MIT
// Gathering from images, by the device's own filter or from texels (volume/image.h).
//
// OpenCL 1.2 has no arrays of images in a kernel: the host writes CLPV_EACH_CASCADE(DO), which writes DO(0) DO(1) ... , one
// a cascade, and each has its parameters and its code.
#ifndef CLPV_GATHER_IMAGE_H
#define CLPV_GATHER_IMAGE_H

#include "volume/light.h"

typedef struct {
  Coefficients r, g, b;
} Sampled;

CLPV_INLINE Sampled clpv_sample(CLPV_IMAGE_IN volume, const float3 at) {
  Sampled s;
  s.r = light_sample(volume, 0, at.x, at.y, at.z);
  s.g = light_sample(volume, 1, at.x, at.y, at.z);
  s.b = light_sample(volume, 2, at.x, at.y, at.z);
  return s;
}

CLPV_INLINE float3 clpv_weigh(const Coefficients weights, const Sampled sampled) {
  return (float3)(clpv_dot(weights, sampled.r), clpv_dot(weights, sampled.g), clpv_dot(weights, sampled.b));
}

#define CLPV_GATHERED CLPV_IMAGE_IN
#define CLPV_GATHERED_VOLUME(c) , CLPV_GATHERED volume##c
#define CLPV_ADD_NUMBERED(c) \
  if (left > 0.0f) CLPV_ADD_CASCADE(c, volume##c);
#define CLPV_GATHERED_VOLUMES CLPV_EACH_CASCADE(CLPV_GATHERED_VOLUME)
#define CLPV_ADD_CASCADES CLPV_EACH_CASCADE(CLPV_ADD_NUMBERED)

#endif
