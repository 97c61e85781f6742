// SPDX-License-Identifier: MIT
#include "options/render_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "basis/basis.hpp"
#include "options/presets.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

// Largest values: beyond any use, so that a slip of the finger is told before gigabytes are asked for.
constexpr double kMostCells = 512, kMostSteps = 4096, kMostTexels = 8192, kMostPixels = 16384,
                 kMostMetres = 1e6;
constexpr int kMostCascades = 8;
constexpr int kMostStride = 16;
constexpr int kMostEntries = 65536;  // what the least of devices with images takes as an image of a buffer

struct Range {
  double least, most;
  bool open = false;  ///< the ends themselves are not allowed
};

struct Path {
  const char* of;  ///< what the file holds
};

struct OneOf {
  std::vector<std::string> names;
};

struct Named {};  ///< the names of the member's enumeration
struct OnOff {};

/// A line a preset.
std::string preset_help() {
  std::string text =
      "a set of options, overridden by any of them that is given\n"
      "best: the defaults: closest to path tracing at about the published scheme's cost\n"
      "paper: the published scheme";
  for (const auto& [name, value] : paper_options()) text += fmt::format(" --{} {}", name, value);
  return text;
}

/// Calls visit(name, member, help, allowed) for every option; the one list of them.
template <typename Options, typename Visit>
void for_each_option(Options& o, Visit&& visit) {
  visit("preset", o.preset, preset_help(), Named{});
  visit("basis", o.basis, "basis of the sphere (clpv basis tells of each)", OneOf{basis_names()});
  visit("centres", o.centres, "an SRBF set of your own, in place of a basis", Path{"directions as JSON"});
  visit("lambda", o.lambda, "bandwidth of the SRBF kernels", Range{0, 1, true});
  visit("lobe", o.lobe, "cosine lobes: projected each, or that along +z turned through a table", Named{});
  visit("lobe-time", o.lobe_time, "propagation's lobes: constants, or made in the kernel as the paper does",
        Named{});
  visit("evaluate", o.evaluate, "SRBF functions: computed, or read from a table", Named{});
  visit("table-size", o.table_size, "entries of those tables", Range{2, kMostEntries});
  visit("table", o.table, "what kernels read those tables as: a buffer, or a 1-D image of it", Named{});
  visit("transport", o.transport, "how light moves from cell to cell", Named{});
  visit("directions", o.directions, "that light is swept along in the finest cascade", Named{});
  visit("coarser-directions", o.coarser_directions, "the same in all other cascades", Named{});
  visit("bounces", o.bounces, "surfaces between a light and the surface seen; more than 1 for a sweep alone",
        Named{});
  visit("state", o.state, "what travels in steps: the basis's coefficients, or six fluxes a cell", Named{});
  visit("layout", o.layout,
        "how volumes lie in memory: 3-D images, or buffers by cell, by coefficient, by blocks", Named{});
  visit("storage", o.storage, "numbers of the volumes; all arithmetic is float", Named{});
  visit("iterations", o.iterations, "propagation steps a cascade; a sweep takes none", Range{0, kMostSteps});
  visit("grid", o.grid, "cells along each axis of a cascade", Range{1, kMostCells});
  visit("cascades", o.cascades, "cascades, each twice the size of the one before", Range{1, kMostCascades});
  visit("cascade-size", o.cascade_size, "edge of the finest cascade [m]; default: the scene's, else 12.5",
        Range{0, kMostMetres, true});
  visit("rsm-size", o.rsm_size, "texels along each side of a reflective shadow map", Range{1, kMostTexels});
  visit("rsm-format", o.rsm_format, "RSM storage; paper: 32-bit depth, 8-bit normal and flux", Named{});
  visit("shadow-size", o.shadow_size, "texels along each side of a direct light's shadow map",
        Range{1, kMostTexels});
  visit("occlusion", o.occlusion, "indirect shadows: the geometry volume blocks light", OnOff{});
  visit("blockers", o.blockers,
        "what blocks light: the scene's triangles, or what lights and the camera see of it", Named{});
  visit("blocking", o.blocking,
        "how surfaces block light: by their area across each axis, or by lobes what meets their lit side",
        Named{});
  visit("blocker-stride", o.blocker_stride, "of the camera's pixels every so many each way become blockers",
        Range{1, kMostStride});
  visit("gather", o.gather,
        "cells that a surface is lit by, of the eight round it: all, or those that no triangle hides",
        Named{});
  visit("gather-offset", o.gather_offset, "how far off the surface light is gathered [cells]", Range{0, 4});
  visit("width", o.width, "image width [pixels]", Range{1, kMostPixels});
  visit("height", o.height, "image height [pixels]", Range{1, kMostPixels});
}

std::string text_of(const std::string& value) {
  return value;
}
std::string text_of(int value) {
  return std::to_string(value);
}
std::string text_of(double value) {
  return fmt::format("{}", value);
}
std::string text_of(bool value) {
  return value ? "on" : "off";
}
std::string text_of(NamedEnum auto value) {
  return std::string(name_of(value));
}

template <NamedEnum E>
std::string allowed_text(const E&, Named) {
  return fmt::format("{}", fmt::join(names_of<E>(), "|"));
}
std::string allowed_text(const std::string&, const OneOf& choices) {
  return fmt::format("{}", fmt::join(choices.names, "|"));
}
std::string allowed_text(bool, OnOff) {
  return "on|off";
}
std::string allowed_text(const std::string&, const Path& path) {
  return fmt::format("a file of {}", path.of);
}
std::string allowed_text(double, const Range& range) {
  return range.open ? fmt::format("between {} and {}, neither included", range.least, range.most)
                    : fmt::format("{}..{}", range.least, range.most);
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

bool parse(std::string_view text, OnOff, bool& out) {
  if (text != "on" && text != "off") return false;
  out = text == "on";
  return true;
}

bool parse(std::string_view text, const Path&, std::string& out) {
  out = text;
  return !text.empty();
}

template <typename Number>
bool parse(std::string_view text, const Range& range, Number& out) {
  const auto value = parse_number<Number>(text);
  const bool inside = value && (range.open ? *value > range.least && *value < range.most
                                           : *value >= range.least && *value <= range.most);
  if (inside) out = *value;
  return inside;
}

}  // namespace

std::unique_ptr<Basis> make_basis(const RenderOptions& options) {
  return options.centres.empty() ? make_basis(options.basis, options.lambda)
                                 : load_basis(options.centres, options.lambda);
}

Transport make_transport(const RenderOptions& options, const Basis& basis) {
  return make_transport(options.transport, basis, options.lobes(), options.blocking);
}

std::vector<OptionDescription> list_options(const RenderOptions& options) {
  std::vector<OptionDescription> list;
  for_each_option(options,
                  [&](const char* name, const auto& member, const std::string& help, const auto& allowed) {
                    list.push_back({name, help, allowed_text(member, allowed), text_of(member)});
                  });
  return list;
}

void set_option(RenderOptions& options, std::string_view name, std::string_view value) {
  bool known = false;
  for_each_option(options, [&](const char* candidate, auto& member, const std::string&, const auto& allowed) {
    if (name != candidate) return;
    known = true;
    if (!parse(value, allowed, member)) {
      throw Error(ExitCode::usage, "{}: found '{}', allowed: {}", name, value, allowed_text(member, allowed));
    }
  });
  if (name == "basis") options.centres.clear();
  if (!known) throw Error(ExitCode::usage, "there is no option '{}'", name);
  if (name == "preset") apply_preset(options, options.preset);
}

nlohmann::json to_json(const RenderOptions& options) {
  nlohmann::json json;
  for_each_option(options, [&](const char* name, const auto& member, const std::string&, const auto&) {
    if constexpr (NamedEnum<std::remove_cvref_t<decltype(member)>>) {
      json[name] = text_of(member);
    } else {
      json[name] = member;
    }
  });
  return json;
}

}  // namespace clpv
