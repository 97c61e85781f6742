// SPDX-License-Identifier: MIT
// A scene's own normals, weighted by the light they send on: what its reflective shadow maps hold.
#pragma once

#include <filesystem>
#include <vector>

#include "basis/lobe_aims.hpp"
#include "device/session.hpp"
#include "options/render_options.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// The normals of all texels that injection would read for this camera, of every cascade, gathered into patches of the
/// sphere: each patch's mean normal, weighted by its share of the flux. Empty where no light falls on anything.
std::vector<WeightedDirection> normal_weights(Session& session, const Scene& scene, const Camera& camera,
                                              const RenderOptions& options);

/// As load_aims reads it.
void write_normal_weights(const std::filesystem::path& path, const std::vector<WeightedDirection>& weights);

}  // namespace clpv
