// SPDX-License-Identifier: MIT
#include "options/presets.hpp"

#include <algorithm>

#include "options/render_options.hpp"

namespace clpv {

// Kaplanyan and Dachsbacher's scheme with the paper's basis, step by step as published.
const std::vector<std::pair<std::string_view, std::string_view>>& paper_options() {
  static const std::vector<std::pair<std::string_view, std::string_view>> options{
      {"basis", "srbf8v2"},      {"lambda", "0.25"},      {"lobe", "rotate"},       {"lobe-time", "kernel"},
      {"evaluate", "table"},     {"table-size", "256"},   {"table", "image"},       {"transport", "sampled"},
      {"state", "coefficients"}, {"rsm-format", "paper"}, {"blockers", "seen"},     {"blocking", "one-sided"},
      {"blocker-stride", "1"},   {"gather", "all"},       {"gather-offset", "0.5"}, {"layout", "image"},
      {"storage", "half"},
  };
  return options;
}

void apply_preset(RenderOptions& options, PresetName name) {
  const std::vector<OptionDescription> defaults = list_options(RenderOptions{});
  for (const auto& [option, value] : paper_options()) {
    const bool paper = name == PresetName::paper;
    set_option(options, option,
               paper ? value : std::ranges::find(defaults, option, &OptionDescription::name)->value);
  }
  options.preset = name;
}

}  // namespace clpv
