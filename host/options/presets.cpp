// SPDX-License-Identifier: MIT
#include "options/presets.hpp"

#include <algorithm>
#include <set>

#include "options/render_options.hpp"
#include "support/named_enum.hpp"

namespace clpv {
namespace {

/// Kaplanyan and Dachsbacher's scheme with the paper's basis, step by step as published.
const std::vector<std::pair<std::string, std::string>>& paper_options() {
  static const std::vector<std::pair<std::string, std::string>> options{
      {"basis", "srbf8v2"},      {"lambda", "0.25"},      {"lobe", "rotate"},       {"lobe-time", "kernel"},
      {"evaluate", "table"},     {"table-size", "256"},   {"table", "image"},       {"transport", "sampled"},
      {"state", "coefficients"}, {"rsm-format", "paper"}, {"blockers", "seen"},     {"blocking", "one-sided"},
      {"blocker-stride", "1"},   {"gather", "all"},       {"gather-offset", "0.5"}, {"layout", "image"},
      {"storage", "half"},
  };
  return options;
}

Preset make_preset(PresetName name) {
  switch (name) {
    case PresetName::best:
      return {name, "the defaults: closest to path tracing at about the published scheme's cost", {}};
    case PresetName::paper:
      return {name, "the published scheme", paper_options()};
  }
  return {};
}

const Preset& preset_named(PresetName name) {
  return *std::ranges::find(presets(), name, &Preset::name);
}

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = [] {
    std::vector<Preset> made;
    for (const PresetName name : values_of<PresetName>()) made.push_back(make_preset(name));
    return made;
  }();
  return all;
}

void apply_preset(RenderOptions& options, PresetName name) {
  const Preset& chosen = preset_named(name);
  std::set<std::string> set_by_some;
  for (const Preset& preset : presets()) {
    for (const auto& [option, value] : preset.options) set_by_some.insert(option);
  }
  for (const OptionInfo& standard : list_options(RenderOptions{})) {
    if (set_by_some.contains(standard.name)) set_option(options, standard.name, standard.value);
  }
  for (const auto& [option, value] : chosen.options) set_option(options, option, value);
  options.preset = chosen.name;
}

}  // namespace clpv
