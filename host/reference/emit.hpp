// SPDX-License-Identifier: MIT
// CPU reference of stage `emit` (kernels/inject/emit.cl): virtual point lights of emissive
// triangles, in double (docs/method.md, 'Emissive surfaces').
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/emission.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// A virtual point light. Its flux is P = pi L A.
struct EmittedPoint {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};  ///< unit, on the emitting side; 0 for a triangle without area
  glm::dvec3 flux{0};    ///< [W]
  double tolerance = 0;  ///< flux of samples close to a masked material's alpha cutoff [W]
};

/// Returns the points of `plan` in order.
std::vector<EmittedPoint> emit(const SceneData& scene, const EmissionPlan& plan);

}  // namespace clpv::reference
