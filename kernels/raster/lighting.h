// SPDX-License-Identifier: MIT
// Irradiance from a light, without occlusion (shared/light.h). Direct light and RSMs share this definition of cone,
// range and distance.
//
//   E = I cone^2 / max(d, d_min)^2      spot and point lights, 0 beyond the range;   E: constant for directional lights
//   E T                                 with CLPV_MEDIUM: T of the path to the light (medium.h)
#ifndef CLPV_LIGHTING_H
#define CLPV_LIGHTING_H

#include "lanes.h"
#include "shared/light.h"
#include "vec.h"

#if CLPV_MEDIUM
#include "gather/medium.h"
#endif

// Irradiance [W/m^2] at `position` [m] on a plane across the ray, before attenuation; 0 for an unknown kind. `towards`: unit
// vector to the light. `to_light` [m]: distance of the light.
static inline Vec clpv_clear_irradiance(const ClpvLight light, const Vec position, Vec* towards, float8* to_light) {
  const Vec intensity = vec_of(light.intensity), direction = vec_of(light.direction);
  if (light.kind == CLPV_LIGHT_DIRECTIONAL) {
    *towards = vec(-direction.x, -direction.y, -direction.z);
    *to_light = (float8)(INFINITY);
    return intensity;
  }
  const Vec offset = vec_minus(vec_of(light.position), position);
  const float8 none = (float8)(0.0f), all = (float8)(1.0f), least = (float8)(CLPV_LIGHT_LEAST_DISTANCE);
  float8 distance = sqrt(vec_dot_unfused(offset, offset));
  distance = distance > least ? distance : least;
  *to_light = distance;
  *towards = vec(offset.x / distance, offset.y / distance, offset.z / distance);
  if (light.kind != CLPV_LIGHT_SPOT && light.kind != CLPV_LIGHT_POINT) return vec(none, none, none);
  float8 attenuation = 1.0f / (distance * distance);
  if (light.kind == CLPV_LIGHT_SPOT) {
    const float8 in_cone = light.cone_offset - light.cone_scale * vec_dot_unfused(*towards, direction);
    const float8 cone = in_cone > none ? (in_cone < all ? in_cone : all) : none;
    attenuation *= cone * cone;
  }
  if (light.range > 0.0f) attenuation = distance > light.range ? none : attenuation;
  return vec_times(intensity, attenuation);
}

// The same after attenuation.
static inline Vec clpv_light_irradiance(const ClpvLight light, const Vec position, Vec* towards) {
  float8 distance;
  const Vec irradiance = clpv_clear_irradiance(light, position, towards, &distance);
#if CLPV_MEDIUM
  const MediumPart part = clpv_medium_part(light.medium, position, *towards, distance);
  return vec_product(irradiance, clpv_transmittance(light.medium, part.end - part.start));
#else
  return irradiance;
#endif
}

#endif
