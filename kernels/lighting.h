// SPDX-License-Identifier: MIT
// What a light sends to a point in space, before anything stands in its way (kernels/shared/light.h).
// The one home of cone, range and distance: direct light, RSMs and their twins must agree on them.
#ifndef CLPV_LIGHTING_H
#define CLPV_LIGHTING_H

#include "shared/light.h"

// Irradiance [W/m^2] at `position` [m] on a plane across the light's ray; `towards`: unit, from there to the light. A
// kind that is none gives no light.
static inline float3 clpv_light_irradiance(const ClpvLight light, const float3 position, float3* towards) {
  const float3 intensity = (float3)(light.intensity[0], light.intensity[1], light.intensity[2]);
  const float3 direction = (float3)(light.direction[0], light.direction[1], light.direction[2]);
  if (light.kind == CLPV_LIGHT_DIRECTIONAL) {
    *towards = -direction;
    return intensity;
  }
  const float3 offset = (float3)(light.position[0], light.position[1], light.position[2]) - position;
  const float distance = fmax(length(offset), CLPV_LIGHT_LEAST_DISTANCE);
  *towards = offset / distance;
  if (light.kind != CLPV_LIGHT_SPOT && light.kind != CLPV_LIGHT_POINT) return (float3)(0.0f);
  if (light.range > 0.0f && distance > light.range) return (float3)(0.0f);
  float attenuation = 1.0f / (distance * distance);
  if (light.kind == CLPV_LIGHT_SPOT) {
    const float cone = clamp(light.cone_offset - light.cone_scale * dot(*towards, direction), 0.0f, 1.0f);
    attenuation *= cone * cone;
  }
  return intensity * attenuation;
}

#endif
