// SPDX-License-Identifier: MIT
// Irradiance from a light, without occlusion (shared/light.h). Direct light and RSMs share this
// definition of cone, range and distance.
//
//   E = I cone^2 / max(d, d_min)^2      spot and point lights, 0 beyond the range;   E: constant
//                                                                                    for
//                                                                                    directional
//                                                                                    lights
//   E T                                 with CLPV_MEDIUM: T of the path to the light (medium.h)
#pragma once

#include "lanes.h"
#include "shared/light.h"
#include "vec.h"

#if CLPV_MEDIUM
#include "gather/medium.h"
#endif

// Irradiance [W/m^2] at `position` [m] on a plane across the ray, before attenuation; 0 for an
// unknown kind. `towards`: unit vector to the light. `to_light` [m]: distance of the light.
static inline Vec clear_irradiance(const ClpvLight light, const Vec position, Vec* towards,
                                   realW* to_light) {
  const Vec intensity = vec_of(light.intensity), direction = vec_of(light.direction);
  if (light.kind == CLPV_LIGHT_DIRECTIONAL) {
    *towards = vec(-direction.x, -direction.y, -direction.z);
    *to_light = (realW)(INFINITY);
    return intensity;
  }
  const Vec offset = vec_minus(vec_of(light.position), position);
  const realW least = (realW)(CLPV_LIGHT_LEAST_DISTANCE);
  realW distance = sqrt(vec_dot_unfused(offset, offset));
  distance = distance > least ? distance : least;
  *to_light = distance;
  *towards = vec(offset.x / distance, offset.y / distance, offset.z / distance);
  if (light.kind != CLPV_LIGHT_SPOT && light.kind != CLPV_LIGHT_POINT) return vec(ZERO, ZERO, ZERO);
  realW attenuation = 1.0f / (distance * distance);
  if (light.kind == CLPV_LIGHT_SPOT) {
    realW opposite = vec_dot_unfused(*towards, direction);  // -cos(angle)
    if (light.narrow_cone) {  // 1 - cos(angle), of unit vectors
      const Vec between = vec(towards->x + direction.x, towards->y + direction.y,
                              towards->z + direction.z);
      opposite = 0.5f * vec_dot_unfused(between, between);
    }
    const realW in_cone = light.cone_offset - light.cone_scale * opposite;
    const realW cone = in_cone > ZERO ? (in_cone < ONE ? in_cone : ONE) : ZERO;
    attenuation *= cone * cone;
  }
  if (light.range > 0.0f) attenuation = distance > light.range ? ZERO : attenuation;
  return vec_times(intensity, attenuation);
}

// clear_irradiance() times the medium's transmittance towards the light.
static inline Vec light_irradiance(const ClpvLight light, const Vec position, Vec* towards) {
  realW distance;
  const Vec irradiance = clear_irradiance(light, position, towards, &distance);
#if CLPV_MEDIUM
  const MediumPart part = find_medium_part(light.medium, position, *towards, distance);
  return vec_product(irradiance, medium_transmittance(light.medium, part.end - part.start));
#else
  return irradiance;
#endif
}
