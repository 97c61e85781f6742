// SPDX-License-Identifier: MIT
// Samples accumulated volumes in images, by the device's filter or from texels (volume/image.h),
// for gather_images.cl.
#pragma once

#include "volume/light.h"
#include "lanes.h"
#include "vec.h"

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
