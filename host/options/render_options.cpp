// SPDX-License-Identifier: MIT
#include "options/render_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "basis/basis.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

// Upper limits, beyond any practical use: a mistyped value fails before memory is allocated.
constexpr double kLeastCells = 3;  // with fewer no light arrives
constexpr double kMaxCells = 512, kMaxSteps = 4096, kMaxBounceSweeps = 16, kMaxTexels = 8192;
// Edge of a cascade [m]. With 512 cells of the smallest, products of a cell's edges are far from a
// float's limits; the largest holds every scene (bounds::kCoordinate).
constexpr double kMinMetres = 1e-6, kMaxMetres = 1e7;
constexpr int kMinRsm = 2, kMinShadow = 4;  // texels: fewer have no interior, and no filter
constexpr int kMaxStride = 16;

struct Range {
  double minimum, maximum;
  bool open = false;  ///< excludes both ends
};

struct Path {
  const char* content;  ///< content of the file
};

struct OneOf {
  std::vector<std::string> names;
};

struct Named {};  ///< names of the member's enumeration

/// Names and values of the options that a preset sets.
using PresetOptions = std::vector<std::pair<std::string_view, std::string_view>>;

const PresetOptions& options_of(PresetName preset) {
  static const PresetOptions best, fast{{"near", "off"}},
      fine{{"near-size", "half"}, {"near-rays", "16"}};
  // The published scheme: that of Kaplanyan and Dachsbacher with the paper's basis and sizes.
  static const PresetOptions paper{
      {"basis", "srbf8v2"},     {"lambda", "0.25"},
      {"lobe", "rotate"},       {"lobe-time", "kernel"},
      {"evaluate", "image"},    {"table-size", "256"},
      {"transport", "sampled"}, {"rsm-format", "paper"},
      {"blockers", "seen"},     {"blocking", "one-sided"},
      {"blocker-stride", "1"},  {"gather", "all"},
      {"gather-offset", "0.5"}, {"layout", "image"},
      {"storage", "half"},      {"grid", "32"},
      {"cascades", "3"},        {"cascade-size", "12.5"},
      {"rsm-size", "256"},      {"iterations", "8"},
      {"near", "off"},          {"width", "960"},
      {"height", "540"},
  };
  switch (preset) {
    case PresetName::best:
      return best;
    case PresetName::fast:
      return fast;
    case PresetName::fine:
      return fine;
    case PresetName::paper:
      return paper;
  }
  return best;
}

/// One line per preset.
std::string preset_help() {
  std::string text =
      "set of options; single options override it\n"
      "best: the defaults, closest to path tracing at about the cost of the published scheme";
  const auto add = [&](PresetName preset, const char* what) {
    text += fmt::format("\n{}: {}:", name_of(preset), what);
    for (const auto& [name, value] : options_of(preset))
      text += fmt::format(" {} {}", flag_of(name), value);
  };
  add(PresetName::fast, "less time");
  add(PresetName::fine, "less noise of the near field, more time");
  text += "\npaper: the published scheme with its sizes (docs/paper/open_choices.md)";
  return text;
}

/// Calls visit(name, member, help, allowed) for every option. This is the only list of render
/// options.
template <typename Options, typename Visit>
void for_each_option(Options& o, Visit&& visit) {
  visit("preset", o.preset, preset_help(), Named{});
  visit("basis", o.basis, "basis of spherical functions (clpv basis describes each)",
        OneOf{basis_names()});
  visit("centres", o.centres, "custom SRBF set, replaces --basis", Path{"centres as JSON"});
  visit("lambda", o.lambda, "parameter of the SRBF kernels, narrower with larger values",
        Range{0, 1, true});
  visit("lobe", o.lobe,
        "cosine lobes: each projected exactly, or the lobe along +z rotated through a table",
        Named{});
  visit("lobe-time", o.lobe_time,
        "lobes of propagation: host constants, or computed in the kernel as in the paper", Named{});
  visit("evaluate", o.evaluate,
        "SRBF evaluation: exact, or from tables in a buffer or a 1-D image buffer", Named{});
  visit("table-size", o.table_size, "entries of lobe and SRBF tables", Range{2, kMaxTableSize});
  visit("transport", o.transport,
        "propagation: steps with sampled or exact face fluxes, or one sweep along directions",
        Named{});
  visit("directions", o.directions, "number of sweep directions in the finest cascade", Named{});
  visit("coarser-directions", o.coarser_directions,
        "number of sweep directions in all other cascades", Named{});
  visit("bounces", o.bounces,
        "number of diffuse bounces; more than 1 needs --transport sweep; auto: all with a sweep, "
        "else 1",
        Named{});
  visit("bounce-sweeps", o.bounce_sweeps,
        "sweeps before the rest of --bounces all is estimated; more carry light "
        "farther through corridors",
        Range{kLeastSeriesSweeps, kMaxBounceSweeps});
  visit("layout", o.layout,
        "memory layout of volumes: 3-D images, or buffers ordered by cell, by coefficient or by "
        "block",
        Named{});
  visit("storage", o.storage, "number format of volumes; arithmetic is float", Named{});
  visit("iterations", o.iterations, "propagation steps per cascade; ignored by --transport sweep",
        Range{0, kMaxSteps});
  visit("grid", o.grid, "cells along each axis of a cascade", Range{kLeastCells, kMaxCells});
  visit("cascades", o.cascades, "number of cascades, each twice as large as the previous one",
        Range{1, kMaxCascades});
  visit(
      "cascade-size", o.cascade_size,
      "edge of the finest cascade [m]; default: the scene file's, else 12.5, or fitted to a model",
      Range{kMinMetres, kMaxMetres});
  visit("rsm-size", o.rsm_size, "texels along each side of a reflective shadow map (RSM)",
        Range{kMinRsm, kMaxTexels});
  visit("rsm-format", o.rsm_format, "RSM format; paper: 32-bit depth, 8-bit normal and flux",
        Named{});
  visit("shadow-size", o.shadow_size, "texels along each side of a shadow map for direct light",
        Range{kMinShadow, kMaxTexels});
  visit("blockers", o.blockers,
        "source of indirect shadows: all triangles of the scene, surfels of RSM and G-buffer, or "
        "none",
        Named{});
  visit("blocking", o.blocking,
        "blocking model: projected area per axis, or a cosine lobe that blocks light on the lit "
        "side (the paper)",
        Named{});
  visit("blocker-stride", o.blocker_stride,
        "distance of the G-buffer's blockers along x and y [pixels], with --blockers seen",
        Range{1, kMaxStride});
  visit(
      "gather", o.gather,
      "cells that light a surface, of the eight nearest: all, or only those that no triangle hides",
      Named{});
  visit("gather-offset", o.gather_offset,
        "distance from the surface at which light is gathered [cells]", Range{0, 4});
  visit("near", o.near,
        "light from surfaces nearer than a cell: from the volumes (off), or by rays (traced), "
        "which needs --transport sweep; auto: traced with a sweep, else off",
        Named{});
  visit(
      "near-size", o.near_size,
      "pixels that have rays of --near-field: all, or one of 2 x 2, 4 x 4 or 8 x 8; auto: about as "
      "many as 240 x 135",
      Named{});
  visit("near-rays", o.near_rays, "rays of each of these pixels", Named{});
  visit("width", o.width, "image width [pixels]", Range{1, kMaxPixels});
  visit("height", o.height, "image height [pixels]", Range{1, kMaxPixels});
}

template <typename T>
std::string text_of(const T& value) {
  if constexpr (NamedEnum<T>)
    return std::string(name_of(value));
  else
    return fmt::format("{}", value);
}

template <NamedEnum E>
std::string allowed_text(const E&, Named) {
  return fmt::format("{}", fmt::join(names_of<E>(), "|"));
}
std::string allowed_text(const std::string&, const OneOf& choices) {
  return fmt::format("{}", fmt::join(choices.names, "|"));
}
std::string allowed_text(const std::string&, const Path& path) {
  return fmt::format("a file of {}", path.content);
}
std::string allowed_text(double, const Range& range) {
  return range.open ? fmt::format("greater than {} and less than {}", range.minimum, range.maximum)
                    : fmt::format("{}..{}", range.minimum, range.maximum);
}

template <NamedEnum E>
bool parse(std::string_view text, Named, E& out) {
  for (const E value : values_of<E>()) {
    if (name_of(value) != text) continue;
    out = value;
    return true;
  }
  return false;
}

bool parse(std::string_view text, const OneOf& choices, std::string& out) {
  if (std::ranges::find(choices.names, text) == choices.names.end()) return false;
  out = text;
  return true;
}

bool parse(std::string_view text, const Path&, std::string& out) {
  out = text;
  return !text.empty();
}

template <typename Number>
bool parse(std::string_view text, const Range& range, Number& out) {
  const auto value = parse_number<Number>(text);
  const bool inside = value && (range.open ? *value > range.minimum && *value < range.maximum
                                           : *value >= range.minimum && *value <= range.maximum);
  if (inside) out = *value;
  return inside;
}

}  // namespace

std::string flag_of(std::string_view name) {
  return fmt::format("--{}", name == "near" ? "near-field" : name);
}

std::unique_ptr<Basis> make_basis(const RenderOptions& options) {
  return options.centres.empty() ? make_basis(options.basis, options.lambda)
                                 : load_basis(options.centres, options.lambda);
}

Transport make_transport(const RenderOptions& options, const Basis& basis) {
  return make_transport(options.transport, basis, options.lobes(), options.blocking);
}

std::vector<OptionDescription> list_options(const RenderOptions& options) {
  std::vector<OptionDescription> list;
  for_each_option(options, [&](const char* name, const auto& member, const std::string& help,
                               const auto& allowed) {
    list.push_back({name, help, allowed_text(member, allowed), text_of(member)});
  });
  return list;
}

void set_option(RenderOptions& options, std::string_view name, std::string_view value) {
  bool known = false;
  for_each_option(
      options, [&](const char* candidate, auto& member, const std::string&, const auto& allowed) {
        if (name != candidate && fmt::format("--{}", name) != flag_of(candidate)) return;
        known = true;
        if (!parse(value, allowed, member)) {
          throw Error(ExitCode::usage, "{}: found '{}', allowed: {}", name, value,
                      allowed_text(member, allowed));
        }
      });
  if (name == "basis") options.centres.clear();
  if (!known) throw Error(ExitCode::usage, "unknown option '{}'", name);
  if (name == "preset") apply_preset(options, options.preset);
}

nlohmann::json to_json(const RenderOptions& options) {
  nlohmann::json json;
  for_each_option(
      options, [&](const char* name, const auto& member, const std::string&, const auto&) {
        if constexpr (NamedEnum<std::remove_cvref_t<decltype(member)>>) {
          json[name] = text_of(member);
        } else if constexpr (std::is_same_v<std::remove_cvref_t<decltype(member)>, std::string>) {
          json[name] = printable(member);
        } else {
          json[name] = member;
        }
      });
  return json;
}

std::string preset_note(const RenderOptions& options, std::string_view name) {
  RenderOptions set;
  apply_preset(set, options.preset);
  const PresetOptions& preset = options_of(options.preset);
  const auto value_in = [&](const RenderOptions& from) {
    const std::vector<OptionDescription> list = list_options(from);
    return std::ranges::find(list, name, &OptionDescription::name)->value;
  };
  if (std::ranges::count(preset, name, &PresetOptions::value_type::first) == 0 ||
      value_in(set) != value_in(options))
    return {};
  return fmt::format(" (set by --preset {})", name_of(options.preset));
}

void apply_preset(RenderOptions& options, PresetName name) {
  const std::vector<OptionDescription> defaults = list_options(RenderOptions{});
  for (const PresetName preset : values_of<PresetName>()) {
    for (const auto& [option, value] : options_of(preset))
      set_option(options, option,
                 std::ranges::find(defaults, option, &OptionDescription::name)->value);
  }
  for (const auto& [option, value] : options_of(name)) set_option(options, option, value);
  options.preset = name;
}

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
      {options.cascades > 1,
       {"coarser-directions"},
       found("cascades", std::to_string(options.cascades)),
       "cascades 2 or more"},
      {options.bounces == Bounces::all,
       {"bounce-sweeps"},
       found("bounces", name_of(options.bounces)),
       "bounces all"},
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
