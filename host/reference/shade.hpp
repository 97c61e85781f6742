// SPDX-License-Identifier: MIT
// Stage `shade` in double: the CPU reference of kernels/shade.cl.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "image/surface_image.hpp"
#include "kernels/shared/light.h"
#include "options/show.hpp"

namespace clpv::reference {

/// Depths [m] along the view's forward axis, row 0 first; 0: nothing there.
struct ShadowMap {
  ClpvView view{};
  std::vector<float> depth;
};

/// A light and its maps, as ShadowedLight.
struct MappedLight {
  ClpvLight light{};
  std::vector<ShadowMap> maps;
};

/// Share of the light, 0..1, that reaches a surface at `position` [m] with unit `normal` turned to the light; `cosine`
/// between normal and the way to the light.
double visibility(const ShadowMap& map, const glm::dvec3& position, const glm::dvec3& normal, double cosine);

/// What the light puts on that surface [W/m^2].
glm::dvec3 direct_irradiance(const MappedLight& light, const glm::dvec3& position, const glm::dvec3& normal);

/// The same of all lights for every pixel of what a camera sees; 0 where there is no surface.
std::vector<glm::dvec3> direct_irradiance(const std::vector<MappedLight>& lights, const SurfaceImage& camera);

/// RGBA of every pixel, from the two irradiances [W/m^2]. Without emissive in `camera` nothing emits.
std::vector<glm::dvec4> shade(Show show, const SurfaceImage& camera, const std::vector<glm::dvec3>& direct,
                              const std::vector<glm::dvec3>& indirect);

}  // namespace clpv::reference
