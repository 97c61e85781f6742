// SPDX-License-Identifier: MIT
// CPU reference of kernels/raster/lighting.h: unshadowed irradiance of directional, point and spot
// lights (KHR_lights_punctual).
#pragma once

#include <glm/glm.hpp>

#include "kernels/shared/light.h"

namespace clpv::reference {

/// Light that arrives at a point.
struct Incident {
  glm::dvec3 irradiance{0};  ///< on a plane across the ray [W/m^2]
  glm::dvec3 towards{0};     ///< unit, from the point to the light
};

/// Returns the light at `position` [m]. Directional: constant. Point: intensity / r^2, 0 beyond the
/// range. Spot: the same times the square of a ramp from the outer to the inner
/// angle (KHR_lights_punctual; shared/light.h). The range is a hard edge, not the recommended
/// smooth window, so that the inverse square is exact inside it. Times the transmittance of
/// ClpvLight::medium.
Incident light_at(const ClpvLight& light, const glm::dvec3& position);

}  // namespace clpv::reference
