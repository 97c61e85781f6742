// SPDX-License-Identifier: MIT
// Options of a user, and the values they resolve to for a scene.
#pragma once

#include "options/render_options.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Returns the edge of the finest cascade for `scene` [m]. It is `size` if the coarsest of `count`
/// cascades then encloses the scene's bounding box from each camera (at 0 s), and is not far too
/// large. Otherwise it is the smallest edge with which the coarsest cascade encloses the box.
double fitting_cascade_size(const SceneData& scene, int count, double size);

/// Resolves options: first the preset or the defaults, then the scene's values, then the user's
/// other options. The cascades of a bare model enclose it unless their size is set. Throws
/// Error(usage) for an invalid value.
RenderOptions resolve_options(const OptionValues& given, const SceneData& scene);

}  // namespace clpv
