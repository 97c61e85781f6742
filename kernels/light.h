// What a light sends out, as the rasteriser (flux of virtual point lights) and the shader (direct light) both take it.
#ifndef CLPV_LIGHT_H
#define CLPV_LIGHT_H

#include "shared/light.h"

// Radiant intensity [W/sr] of a spot or point light along the unit `travel`, of what it lights at `distance` [m]: cone
// and range included as KHR_lights_punctual has them, the falloff with distance squared not.
static inline float3 clpv_radiant_intensity(const ClpvLight light, const float3 travel, const float distance) {
  float attenuation = 1.0f;
  if (light.kind == CLPV_LIGHT_SPOT) {
    const float cosine =
        travel.x * light.direction[0] + travel.y * light.direction[1] + travel.z * light.direction[2];
    const float cone = clamp(cosine * light.cone_scale + light.cone_offset, 0.0f, 1.0f);
    attenuation = cone * cone;
  }
  if (light.range > 0.0f) {
    const float part = distance / light.range;
    attenuation *= clamp(1.0f - part * part * part * part, 0.0f, 1.0f);
  }
  return attenuation * (float3)(light.intensity[0], light.intensity[1], light.intensity[2]);
}

#endif
