// SPDX-License-Identifier: MIT
// Presets: named sets of render options (--preset). Single options override what they set.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "options/choices.hpp"

namespace clpv {

struct RenderOptions;

struct Preset {
  PresetName name;
  std::string help;
  std::vector<std::pair<std::string, std::string>> options;  ///< long name and value; all others: the default
};

/// `best`, which is the defaults, and `paper`, the published scheme.
const std::vector<Preset>& presets();

/// Gives every option that some preset sets its value in this one (else its default); the others, such as
/// the image's size, stay as they are.
void apply_preset(RenderOptions& options, PresetName name);

}  // namespace clpv
