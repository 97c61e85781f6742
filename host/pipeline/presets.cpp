#include "pipeline/presets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "pipeline/options.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

/// Kaplanyan and Dachsbacher's scheme with the paper's basis, step by step as published.
const std::vector<std::pair<std::string, std::string>>& paper_options() {
  static const std::vector<std::pair<std::string, std::string>> options{
      {"basis", "srbf8v2"},      {"lambda", "0.25"},        {"lobe", "rotate"},
      {"lobe-time", "kernel"},   {"evaluate", "table"},     {"table-size", "256"},
      {"transport", "sampled"},  {"state", "coefficients"}, {"rsm-format", "paper"},
      {"blocking", "one-sided"}, {"blocker-stride", "1"},   {"injection", "nearest"},
      {"gather-offset", "0.5"},  {"gather-floor", "0"},     {"late-light", "off"},
      {"layout", "image"},       {"storage", "half"},
  };
  return options;
}

const Preset& preset_named(std::string_view name) {
  const auto found = std::ranges::find(presets(), name, &Preset::name);
  if (found != presets().end()) return *found;
  throw Error(ExitCode::usage, "--preset: found '{}', allowed: {}", name, fmt::join(preset_names(), "|"));
}

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all{
      {"best", "the defaults: closest to path tracing at about the published scheme's cost", {}},
      {"paper", "the published scheme", paper_options()},
  };
  return all;
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.push_back(preset.name);
  return names;
}

void apply_preset(RenderOptions& options, std::string_view name) {
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
