// SPDX-License-Identifier: MIT
// Stage `emit` in double: the CPU reference of kernels/emit.cl.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/emission.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

struct EmittedPoint {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};  ///< unit, on the side that shines; 0 where the triangle has no area
  glm::dvec3 flux{0};    ///< [W]
  double doubt =
      0;  ///< of the flux, where rounding decides whether looks at a masked material meet a hole [W]
};

std::vector<EmittedPoint> emit(const Scene& scene, const EmissionPlan& plan);

}  // namespace clpv::reference
