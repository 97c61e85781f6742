// SPDX-License-Identifier: MIT
#include "options/validate.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "basis/basis.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"

namespace clpv {
namespace {

/// A value that needs another option to have other values.
struct Contradiction {
  bool found;
  const char* option;
  std::string_view value;
  std::string with;     ///< "transport 'sampled'"
  std::string allowed;  ///< values of `option`, and how to allow `value`
};

std::vector<Contradiction> contradictions_of(const RenderOptions& o, const SceneData& scene) {
  const bool sweeps = o.transport == TransportKind::sweep;
  const std::string transport = fmt::format("transport '{}'", name_of(o.transport));
  return {
      {o.blockers == Blockers::scene && o.blocking != Blocking::areas, "blocking",
       name_of(o.blocking), "blockers 'scene'", "areas (or blockers 'seen')"},
      {!sweeps && o.reflects(), "bounces", name_of(o.bounces), transport,
       "1 (or transport 'sweep')"},
      {!sweeps && o.near == Near::traced, "near", name_of(o.near), transport,
       "off (or transport 'sweep')"},
      {sweeps && o.lobe_time != LobeTime::host, "lobe-time", name_of(o.lobe_time),
       transport + ", which has no lobes", "host"},
      // Steps take no light at the border of the cascades, and attenuate none.
      {!sweeps && scene.sky != nullptr, "transport", name_of(o.transport), "a sky",
       "sweep (or a scene without a sky)"},
      {!sweeps && scene.medium.has_value(), "transport", name_of(o.transport), "a medium",
       "sweep (or a scene without a medium)"},
  };
}

/// A condition under which some options have an effect, and what it depends on.
struct Effect {
  bool exists;
  std::vector<const char*> options;
  std::string without;  ///< the option and value that take the effect away
  std::string with;     ///< values with which there is one
};

std::vector<Effect> effects_of(const OptionValues& given, const RenderOptions& options,
                               bool centred) {
  const auto found = [&](const char* name, std::string_view value) {
    const std::string preset = preset_note(options, name);
    const std::string source = given.contains(name) ? ""
                               : preset.empty()     ? " (the default)"
                                                    : preset;
    return fmt::format("{} {}{}", name, value, source);
  };
  const bool sweeps = options.transport == TransportKind::sweep;
  const bool tables = options.lobe == LobeKind::rotate || options.evaluate != Evaluation::exact;
  const std::string transport = found("transport", name_of(options.transport)),
                    basis = found("basis", options.basis),
                    blockers = found("blockers", name_of(options.blockers));
  return {
      {!sweeps, {"iterations"}, transport, "transport sampled or exact"},
      {sweeps, {"directions", "coarser-directions"}, transport, "transport sweep"},
      {options.bounces == Bounces::all,
       {"bounce-sweeps"},
       found("bounces", name_of(options.bounces)),
       "bounces all"},
      {options.cascades > 1,
       {"coarser-directions"},
       found("cascades", std::to_string(options.cascades)),
       "cascades 2 or more"},
      {centred, {"lambda", "lobe", "evaluate"}, basis, "a basis with centres (srbf...)"},
      {!sweeps, {"evaluate"}, transport, "transport sampled or exact"},
      {tables,
       {"table-size"},
       found("lobe", name_of(options.lobe)),
       "lobe rotate or evaluate buffer or image"},
      {sweeps, {"near-size", "near-rays"}, transport, "transport sweep"},
      {options.traces_near(),
       {"near-size", "near-rays"},
       found("near", name_of(options.near)),
       "near traced"},
      {options.blocked(), {"blocking"}, blockers, "blockers scene or seen"},
      {options.blockers == Blockers::seen, {"blocker-stride"}, blockers, "blockers seen"},
  };
}

}  // namespace

void validate(const RenderOptions& options, const SceneData& scene) {
  for (const Contradiction& c : contradictions_of(options, scene)) {
    if (!c.found) continue;
    throw Error(ExitCode::usage, "{}: found '{}'{} with {}, allowed: {}", c.option, c.value,
                preset_note(options, c.option), c.with, c.allowed);
  }
}

void reject_without_effect(const OptionValues& given, const RenderOptions& options,
                           const Basis& basis) {
  for (const Effect& effect : effects_of(given, options, !basis.centres().empty())) {
    if (effect.exists) continue;
    for (const char* name : effect.options) {
      if (const auto found = given.find(name); found != given.end())
        throw Error(ExitCode::usage, "{} {} has no effect with {}; allowed with {}", name,
                    found->second, effect.without, effect.with);
    }
  }
}

}  // namespace clpv
