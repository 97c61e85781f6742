// SPDX-License-Identifier: MIT
// Options as a user gives them, and what they come to for a scene.
#pragma once

#include <map>
#include <string>

#include "options/render_options.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// What a user gave, by name.
using OptionValues = std::map<std::string, std::string>;

/// The preset given, else the defaults; then what the scene wishes, then the other options given. A bare model's cascades
/// hold it unless their size is given. Throws Error(usage) for a bad value.
RenderOptions resolve_options(const OptionValues& given, const Scene& scene);

}  // namespace clpv
