// SPDX-License-Identifier: MIT
// Gathers irradiance as gather.cl does, from accumulated volumes in images.
//
// In:   places, normals, grids, cascades, unit   as in gather.cl
//       one image for each cascade
//       table of G (basis/table.h), if functions are looked up
// Out:  irradiance  E [W/m^2] per pixel
// A work-item processes W pixels of a row (gathering.h).
//
// OpenCL 1.2 has no arrays of images. From the host: CLPV_EACH_CASCADE(DO), which is DO(0) DO(1)
// ... for the numbers of all cascades, each with its own parameter and code.
#include "volume/light.h"
#include "lanes.h"
#include "vec.h"

typedef struct {
  Coefficients r, g, b;
} Sampled;

typedef struct {
  float x[W], y[W], z[W];
} SamplePoints;

CLPV_INLINE void find_sample_points(const Vec at, const Vec clear, const Vec eye,
                                    SamplePoints* points) {
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
#include "gather/gathering.h"

#define CLPV_AND_IMAGE(c) , __read_only image3d_t volume##c
#define CLPV_ADD_IMAGE(c) add_cascade(&g, grids + c, volume##c);

__kernel void gather_images(const ClpvView view, __global const Place* places,
                            __global const float4* normals, __global const ClpvGrid* grids,
                            const uint cascades, const float unit,
                            __global float4* irradiance CLPV_EACH_CASCADE(CLPV_AND_IMAGE)
                                CLPV_AND_G) {
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  Gathering g;
  CLPV_LOAD_SURFACES(view, p, places, normals, &g.surfaces);
  begin_gathering(view, &g CLPV_PASS_G);
  CLPV_EACH_CASCADE(CLPV_ADD_IMAGE)
  for (uint i = 0; i < p.count; ++i) irradiance[g.surfaces.first + i] = unit * g.sums[i];
}
