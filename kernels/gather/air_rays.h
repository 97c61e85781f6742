// SPDX-License-Identifier: MIT
// Rays from the camera through a medium, and the points where they gather its light (medium.cl).
//
//   t_k: distances in the medium, with density proportional to exp(-sigma t), sigma the mean
//   extinction; dt_k: length [m] of the ray that point k stands for
#pragma once

#include "raster/shadow.h"
#include "raster/surface_row.h"

__constant const float thin_depth = 1e-3f;  // optical depth below which points are spread evenly

// Parts of the rays of W pixels in the medium.
typedef struct {
  Vec origin, direction;  // unit
  realW start, end;      // [m]
  intW inside;            // the ray is in the medium
} AirRays;

CLPV_INLINE void find_air_rays(const ClpvView view, const PixelRow p, const realW depth,
                               const ClpvMedium medium, AirRays* a) {
  const Vec eye = vec_of(view.eye), along = vec_minus(row_positions(view, p, ONE), eye);
  const realW length = sqrt(vec_dot(along, along));
  a->origin = eye;
  a->direction = vec_times(along, 1.0f / length);
  const MediumPart part = find_medium_part(medium, eye, a->direction,
                                           depth > ZERO ? depth * length : (realW)(INFINITY));
  a->inside = part.end > part.start;
  a->start = a->inside ? part.start : ZERO;
  a->end = a->inside ? part.end : ZERO;
}

// A point of each ray.
typedef struct {
  realW at;           // distance from the camera [m]
  // path: t, the point's distance in the medium [m]; step: dt exp(-sigma t) [m]; sigma the mean
  // extinction [1/m].
  realW path, step;
  float sigma;
} AirPoint;

// Point k of `steps` of each ray.
CLPV_INLINE void find_air_point(const AirRays* a, const ClpvMedium medium, const realW place,
                                const int k, const int steps, AirPoint* p) {
  const float sigma =
      (medium.extinction[0] + medium.extinction[1] + medium.extinction[2]) * (1.0f / 3.0f);
  const realW length = a->end - a->start, x = (place + (float)k) * (1.0f / (float)steps);
  const realW reached = 1.0f - exp(-sigma * length);
  const intW thin = sigma * length < (realW)(thin_depth);
  const realW deep = -log(1.0f - x * reached) * (1.0f / sigma);
  const realW t = thin ? x * length : (deep < length ? deep : length);
  const realW spread = thin ? length * exp(-sigma * t) : reached * (1.0f / sigma);
  p->at = a->start + t;
  p->path = t;
  p->step = spread * (1.0f / (float)steps);
  p->sigma = sigma;
}

// exp(-sigma_t (t + further)) dt of each channel [m]. `further` [m]: way through the medium from
// the light to the point.
CLPV_INLINE Vec air_share(const AirPoint* p, const ClpvMedium medium, const realW further) {
  const realW way = p->path + (further > ZERO ? further : ZERO), before = p->sigma * p->path;
  return vec_times(
      vec(exp(before - medium.extinction[0] * way), exp(before - medium.extinction[1] * way),
          exp(before - medium.extinction[2] * way)),
      p->step);
}
