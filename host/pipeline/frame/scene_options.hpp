// SPDX-License-Identifier: MIT
// Options of a user, and the values they resolve to for a scene.
#pragma once

#include "options/render_options.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Resolves options: first the preset or the defaults, then the scene's values, then the user's
/// other options. The cascades of a bare model enclose it unless their size is set. Throws
/// Error(usage) for an invalid value.
RenderOptions resolve_options(const OptionValues& given, const SceneData& scene);

}  // namespace clpv
