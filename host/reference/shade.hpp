// SPDX-License-Identifier: MIT
// CPU reference of stage `shade` (kernels/raster/shade.cl): shadowed direct light and the final
// image, in double (docs/method.md, 'Shading').
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "image/image.hpp"
#include "kernels/shared/light.h"
#include "options/show.hpp"

namespace clpv::reference {

/// Depths [m] along the view's forward axis, row 0 first; 0: no surface.
struct ShadowMap {
  ClpvView view{};
  std::vector<float> depth;
};

/// A light and its shadow maps; the counterpart of ShadowedLight.
struct MappedLight {
  ClpvLight light{};
  std::vector<ShadowMap> maps;
};

/// Returns the map of a light that covers a point: the one whose view looks most along `offset`,
/// from the light to the point.
const ShadowMap& map_towards(const std::vector<ShadowMap>& maps, const glm::dvec3& offset);

/// Returns the share [0, 1] of the light that reaches a surface at `position` [m] whose triangle
/// has the unit `normal`, on the lit side. `cosine`: of the angle between `normal` and the
/// direction to the light; `flat`: the shading normal is the triangle's.
double visibility(const ShadowMap& map, const glm::dvec3& position, const glm::dvec3& normal,
                  double cosine, bool flat = true);

/// Returns the irradiance of a light on a surface [W/m^2]: `normal` weighs light, `geometric`, its
/// triangle's, decides which side it comes from (kernels/shared/normal.h).
glm::dvec3 direct_irradiance(const MappedLight& light, const glm::dvec3& position,
                             const glm::dvec3& normal, const glm::dvec3& geometric);

/// Returns the irradiance of all lights for every pixel of a G-buffer; 0 for pixels without a
/// surface.
std::vector<glm::dvec3> direct_irradiance(const std::vector<MappedLight>& lights,
                                          const SurfaceImage& camera);

/// Returns RGBA of every pixel: albedo / pi (direct + indirect) + emission, or the part that `show`
/// selects. `direct` and `indirect` are irradiances [W/m^2]. Without `camera.emissive`, emission is
/// 0.
std::vector<glm::dvec4> shade(Show show, const SurfaceImage& camera,
                              const std::vector<glm::dvec3>& direct,
                              const std::vector<glm::dvec3>& indirect);

}  // namespace clpv::reference
