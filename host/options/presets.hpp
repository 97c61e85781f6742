// SPDX-License-Identifier: MIT
// Presets: named sets of render options (--preset). Single options override them.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "options/choices.hpp"

namespace clpv {

struct RenderOptions;

/// Returns names and values of the options that `paper` (the published scheme) sets. `best` leaves them at their defaults.
const std::vector<std::pair<std::string_view, std::string_view>>& paper_options();

/// Sets these options to their values in the preset. Other options, such as the image size, do not change.
void apply_preset(RenderOptions& options, PresetName name);

}  // namespace clpv
