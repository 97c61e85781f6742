// SPDX-License-Identifier: MIT
// Presets: named sets of render options (--preset). Single options override what they set.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "options/choices.hpp"

namespace clpv {

struct RenderOptions;

/// Long names and values of the options that `paper`, the published scheme, sets; `best` leaves them at their defaults.
const std::vector<std::pair<std::string_view, std::string_view>>& paper_options();

/// Gives those options their values in this preset; the others, such as the image's size, stay as they are.
void apply_preset(RenderOptions& options, PresetName name);

}  // namespace clpv
