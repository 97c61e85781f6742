// SPDX-License-Identifier: MIT
// Samples accumulated volumes in images, by the device's filter or from texels (volume/image.h),
// for gather.cl.
//
// OpenCL 1.2 has no arrays of images: CLPV_EACH_CASCADE(DO), from the host, writes DO(0) DO(1) ...
// for each cascade, each with its own parameter and code.
#pragma once

#include "volume/light.h"

typedef struct {
  Coefficients r, g, b;
} Sampled;

typedef struct {
  float x[W], y[W], z[W];
} SamplePoints;

CLPV_INLINE void find_sample_points(const Vec at, SamplePoints* points) {
  store_lanes(at.x, points->x);
  store_lanes(at.y, points->y);
  store_lanes(at.z, points->z);
}

CLPV_INLINE float sample_cells(__read_only image3d_t volume, const SamplePoints* at, const int i,
                               Sampled* s) {
  s->r = light_sample(volume, 0, at->x[i], at->y[i], at->z[i]);
  s->g = light_sample(volume, 1, at->x[i], at->y[i], at->z[i]);
  s->b = light_sample(volume, 2, at->x[i], at->y[i], at->z[i]);
  return 1.0f;
}

CLPV_INLINE float4 weigh(const Coefficients weights, const Sampled sampled) {
  return (float4)(dot_coefficients(weights, sampled.r), dot_coefficients(weights, sampled.g),
                  dot_coefficients(weights, sampled.b), 0.0f);
}

#define CLPV_GATHERED __read_only image3d_t
#define CLPV_GATHERED_VOLUME(c) , CLPV_GATHERED volume##c
#define CLPV_ADD_NUMBERED(c) \
  CLPV_ADD_CASCADE(c, volume##c);
#define CLPV_GATHERED_VOLUMES CLPV_EACH_CASCADE(CLPV_GATHERED_VOLUME)
#define CLPV_ADD_CASCADES CLPV_EACH_CASCADE(CLPV_ADD_NUMBERED)
