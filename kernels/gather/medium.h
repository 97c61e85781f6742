// SPDX-License-Identifier: MIT
// Paths through a medium (shared/light.h), W at a time.
#pragma once

#include "lanes.h"
#include "shared/light.h"
#include "vec.h"

// Part of a ray inside the medium: from `start` to `end`, in lengths of the ray's direction. Empty:
// end <= start.
typedef struct {
  realW start, end;
} MediumPart;

// Part of the ray origin + t direction with t in (0, end). For rays in a face's plane, 0 times
// infinity is NaN, which fmin and fmax ignore.
CLPV_INLINE MediumPart find_medium_part(const ClpvMedium medium, const Vec origin,
                                        const Vec direction, const realW end) {
  const Vec lower = vec_of(medium.lower), upper = vec_of(medium.upper);
  const Vec inverse = vec(1.0f / direction.x, 1.0f / direction.y, 1.0f / direction.z);
  const Vec first = vec_product(vec_minus(lower, origin), inverse),
            last = vec_product(vec_minus(upper, origin), inverse);
  MediumPart part;
  part.start =
      fmax(fmax(fmin(first.x, last.x), fmin(first.y, last.y)), fmax(fmin(first.z, last.z), ZERO));
  part.end =
      fmin(fmin(fmax(first.x, last.x), fmax(first.y, last.y)), fmin(fmax(first.z, last.z), end));
  return part;
}

// exp(-sigma_t l) for each channel, l [m].
CLPV_INLINE Vec medium_transmittance(const ClpvMedium medium, const realW length) {
  const realW l = length > ZERO ? length : ZERO;
  return vec(exp(-medium.extinction[0] * l), exp(-medium.extinction[1] * l),
             exp(-medium.extinction[2] * l));
}

// sigma_s / sigma_t of a channel, the part of attenuated light that is scattered; 0 where nothing
// is attenuated.
CLPV_INLINE float medium_albedo(const ClpvMedium medium, const int channel) {
  return medium.extinction[channel] > 0.0f ? medium.scattering[channel] / medium.extinction[channel]
                                           : 0.0f;
}

// p for the cosine of the angle between both directions [1/sr].
CLPV_INLINE realW phase_function(const float g, const realW cosine) {
  const realW d = 1.0f + g * g - 2.0f * g * cosine;
  return (1.0f - g * g) / (4.0f * M_PI_F * d * sqrt(d));
}
