// SPDX-License-Identifier: MIT
// What a light sends to a point in space, before anything stands in its way: the CPU reference of kernels/lighting.h.
#pragma once

#include <glm/glm.hpp>

#include "kernels/shared/light.h"

namespace clpv::reference {

/// Irradiance [W/m^2] a channel, on a plane across the light's ray, and where the light is.
struct Incident {
  glm::dvec3 irradiance{0};
  glm::dvec3 towards{0};  ///< unit, from the point to the light
};

/// The light at `position` [m]: directional constant; else intensity / r^2, 0 beyond the range, and for a
/// spot times clamp(cos(angle) cone_scale + cone_offset, 0, 1)^2 (KHR_lights_punctual). A hard edge at the
/// range, not the recommended smooth window: inside it the inverse square stays exact.
Incident light_at(const ClpvLight& light, const glm::dvec3& position);

}  // namespace clpv::reference
