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

typedef struct {
  float x[CLPV_ABREAST], y[CLPV_ABREAST], z[CLPV_ABREAST];
} Places;

CLPV_INLINE void clpv_places(const Vec at, Places* places) {
  vstore8(at.x, 0, places->x);
  vstore8(at.y, 0, places->y);
  vstore8(at.z, 0, places->z);
}

CLPV_INLINE float clpv_sample(CLPV_IMAGE_IN volume, const Places* at, const int i, Sampled* s) {
  s->r = light_sample(volume, 0, at->x[i], at->y[i], at->z[i]);
  s->g = light_sample(volume, 1, at->x[i], at->y[i], at->z[i]);
  s->b = light_sample(volume, 2, at->x[i], at->y[i], at->z[i]);
  return 1.0f;
}

CLPV_INLINE float4 clpv_weigh(const Coefficients weights, const Sampled sampled) {
  return (float4)(clpv_dot(weights, sampled.r), clpv_dot(weights, sampled.g), clpv_dot(weights, sampled.b), 0.0f);
}

#define CLPV_GATHERED CLPV_IMAGE_IN
#define CLPV_GATHERED_VOLUME(c) , CLPV_GATHERED volume##c
#define CLPV_ADD_NUMBERED(c) \
  CLPV_ADD_CASCADE(c, volume##c);
#define CLPV_GATHERED_VOLUMES CLPV_EACH_CASCADE(CLPV_GATHERED_VOLUME)
#define CLPV_ADD_CASCADES CLPV_EACH_CASCADE(CLPV_ADD_NUMBERED)

#endif
