// SPDX-License-Identifier: MIT
// CPU reference of stage `near` (kernels/gather/near.cl): light from near surfaces, by brute force
// and in double (docs/method.md, 'Near field').
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "image/image.hpp"
#include "options/stage_options.hpp"
#include "reference/gather.hpp"
#include "reference/materials.hpp"
#include "reference/shade.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// A ray. Rays that pass within kNearEdge of an edge, an end or a limit are uncertain: rounding may
/// decide what they hit.
struct NearRay {
  glm::dvec3 from{0}, along{0};  ///< origin [m], unit direction
  double reach = 0;              ///< [m]
};
inline constexpr double kNearEdge = 1e-3;  // relative

struct NearHit {
  SurfacePoint point;
  double distance = 0;  ///< [m]
};

/// Returns the nearest triangle along a ray, on either side, but not in holes of masked materials.
/// Sets `uncertain` if rounding may decide it.
std::optional<NearHit> nearest_triangle(const SceneData& scene, const Materials& materials,
                                        const NearRay& ray, bool& uncertain);

struct NearScene {
  const SceneData& scene;
  const Materials& materials;
  const std::vector<MappedLight>& lights;
  const std::vector<Cascade>& cascades;  ///< finest first
};

struct NearResult {
  std::vector<glm::dvec3> irradiance;  ///< [W/m^2] per pixel
  std::vector<bool> uncertain;         ///< pixels that rounding may decide
};

/// Returns the gathered irradiance with the light of near surfaces replaced. `basis`: of the
/// cascades' volumes.
NearResult near(const Basis& basis, const NearOptions& options, const NearScene& scene,
                const SurfaceImage& camera, const std::vector<glm::dvec3>& gathered);

}  // namespace clpv::reference
