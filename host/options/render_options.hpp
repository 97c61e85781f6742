// SPDX-License-Identifier: MIT
// Render options as one typed value, and the table of their names, help texts and limits. The
// command line, --stats, image metadata and presets use this table. Independent of OpenCL.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "basis/blocking.hpp"
#include "basis/bounce.hpp"
#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"
#include "clpv/options.hpp"
#include "options/choices.hpp"

namespace clpv {

/// Name of an option on the command line: "--near-field" of `near`, "--NAME" of all others.
std::string flag_of(std::string_view name);

inline constexpr int kMaxPixels = 16384;     ///< along a side of an image
inline constexpr int kMaxTableSize = 65536;  ///< minimum of CL_DEVICE_IMAGE_MAX_BUFFER_SIZE

inline constexpr int kMaxCascades = 8;

/// Options of a frame. The defaults are the preset `best`: closest to path tracing at about the
/// cost of the published scheme (docs/method.md).
struct RenderOptions {
  PresetName preset = PresetName::best;  ///< the last preset set; later options may override it
  std::string basis = "sh2";  ///< one of basis_names(), or the name in the file `centres`
  std::string centres;        ///< file of an SRBF set that replaces `basis`; empty: none
  double lambda = 0.25;
  LobeKind lobe = LobeKind::exact;
  LobeTime lobe_time = LobeTime::host;
  int table_size = 256;
  Evaluation evaluate = Evaluation::exact;
  TransportKind transport = TransportKind::sweep;
  Directions directions = Directions::of96;
  Directions coarser_directions = Directions::of96;
  Bounces bounces = Bounces::automatic;
  int bounce_sweeps = kSeriesSweeps;
  Layout layout = Layout::soa;
  Storage storage = Storage::float16;
  int iterations = 8;
  int grid = 32;
  int cascades = 3;
  double cascade_size = 12.5;
  int rsm_size = 256;
  RsmFormat rsm_format = RsmFormat::float32;
  int shadow_size = 1024;
  Blockers blockers = Blockers::scene;
  Blocking blocking = Blocking::areas;
  int blocker_stride = 3;
  Gathering gather = Gathering::visible;
  double gather_offset = usual_gather_offset(Gathering::visible);
  Near near = Near::automatic;
  NearSize near_size = NearSize::automatic;
  NearRays near_rays = NearRays::of2;
  int width = 960, height = 540;

  VolumeFormat format() const { return {layout, storage}; }
  LobeOptions lobes() const { return {lobe, table_size, evaluate != Evaluation::exact}; }
  /// True if surfaces reflect swept light.
  bool reflects() const { return bounces == Bounces::two || bounces == Bounces::all; }
  /// True if the near field is traced.
  bool traces_near() const {
    return near == Near::traced || (near == Near::automatic && transport == TransportKind::sweep);
  }
  bool blocked() const { return blockers != Blockers::none; }
  TableStorage table() const {
    return evaluate == Evaluation::image ? TableStorage::image : TableStorage::buffer;
  }
};

/// Options that the user set, by name.
using OptionValues = std::map<std::string, std::string>;

/// Creates the basis and transport of the options. Throws as make_basis and load_basis do.
std::unique_ptr<Basis> make_basis(const RenderOptions& options);
Transport make_transport(const RenderOptions& options, const Basis& basis);

/// Returns all options with their current values, in the order of --help.
std::vector<OptionDescription> list_options(const RenderOptions& options);

/// Sets one option from text. `preset` sets every option that any preset names, so set it before
/// options that override it. `basis` clears `centres`. Throws Error(usage) with option, value found
/// and values allowed, for example "layout: found 'planes', allowed: image|aos|soa|tiled".
void set_option(RenderOptions& options, std::string_view name, std::string_view value);

/// Returns every option by name, as a number, string or boolean.
nlohmann::json to_json(const RenderOptions& options);

/// Returns " (set by --preset NAME)" if the option has the value that the preset gave it, else "".
/// For errors.
std::string preset_note(const RenderOptions& options, std::string_view name);

/// Sets these options to their values in the preset, those of other presets to their defaults.
/// Other options do not change.
void apply_preset(RenderOptions& options, PresetName name);

}  // namespace clpv
