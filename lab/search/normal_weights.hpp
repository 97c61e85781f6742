// SPDX-License-Identifier: MIT
// Surface normals of a scene's reflective shadow maps, weighted by reflected flux.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "options/render_options.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// A direction and its weight.
struct WeightedDirection {
  glm::dvec3 direction;  ///< unit
  double weight;         ///< above 0
};

/// Groups the normals of all texels that injection reads for this camera, in all cascades, by
/// patches of the sphere. Returns each patch's mean normal, weighted by its share of the flux.
/// Empty if no surface is lit.
std::vector<WeightedDirection> normal_weights(Session& session, const SceneData& scene,
                                              const SceneCamera& camera,
                                              const RenderOptions& options);

/// Returns {"weights": [[x, y, z, weight], ...]}, the input of clpv_lab.search.
std::string to_json(const std::vector<WeightedDirection>& weights);

}  // namespace clpv
