// SPDX-License-Identifier: MIT
// Options that contradict each other or the scene, or have no effect.
#pragma once

#include "options/render_options.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Throws Error(usage) if options contradict each other or the scene: names one, its value, the
/// other, and the values allowed with it.
void validate(const RenderOptions& options, const SceneData& scene);

/// Throws Error(usage) if an option that the user gave has no effect with the others; names both.
/// `basis`: of the options.
void reject_without_effect(const OptionValues& given, const RenderOptions& options,
                           const Basis& basis);

}  // namespace clpv
