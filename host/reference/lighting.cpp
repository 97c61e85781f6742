// SPDX-License-Identifier: MIT
#include "reference/lighting.hpp"

#include <algorithm>
#include <limits>

#include "reference/view.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

namespace {

/// light_at() without the medium.
Incident clear_light_at(const ClpvLight& light, const glm::dvec3& position) {
  const glm::dvec3 direction = vector(light.direction), intensity = vector(light.intensity);
  const LightKind kind = kind_of(light);
  if (kind == LightKind::directional) return {intensity, -direction};
  const glm::dvec3 offset = vector(light.position) - position;
  const double distance = std::max(glm::length(offset), double{CLPV_LIGHT_LEAST_DISTANCE});
  const glm::dvec3 towards = offset / distance;
  if (light.range > 0 && distance > light.range) return {glm::dvec3(0), towards};
  double attenuation = 1 / (distance * distance);
  switch (kind) {
    case LightKind::directional:
    case LightKind::point:
      break;
    case LightKind::spot: {
      const glm::dvec3 between = towards + direction;
      const double opposite =
          light.narrow_cone != 0 ? 0.5 * glm::dot(between, between) : glm::dot(towards, direction);
      const double cone = std::clamp(light.cone_offset - light.cone_scale * opposite, 0.0, 1.0);
      attenuation *= cone * cone;
      break;
    }
  }
  return {intensity * attenuation, towards};
}

}  // namespace

Incident light_at(const ClpvLight& light, const glm::dvec3& position) {
  Incident incident = clear_light_at(light, position);
  const double distance = kind_of(light) == LightKind::directional
                              ? std::numeric_limits<double>::infinity()
                              : glm::length(vector(light.position) - position);
  incident.irradiance *=
      transmittance(light.medium, medium_part(light.medium, position, incident.towards, distance));
  return incident;
}

}  // namespace clpv::reference
