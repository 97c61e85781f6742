// SPDX-License-Identifier: MIT
// Every choice that shapes a rendered frame, as one typed value; and the one table of names and texts that the command
// line, --stats, image metadata and presets go through. Below it no text stands for a choice. Knows no OpenCL.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "basis/blocking.hpp"
#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"
#include "clpv/options.hpp"
#include "options/choices.hpp"

namespace clpv {

/// The defaults are the preset `best`, and stand here alone: what comes closest to path tracing at about the
/// published scheme's cost (docs/method.md, 'Presets').
struct RenderOptions {
  PresetName preset = PresetName::best;  ///< the one set last; options set after it may differ from it
  std::string basis = "bins24";          ///< one of basis_names(), or the name in `centres`
  std::string centres;                   ///< file of an SRBF set that replaces `basis`; none: empty
  double lambda = 0.25;
  LobeKind lobe = LobeKind::exact;
  LobeTime lobe_time = LobeTime::host;
  int table_size = 256;
  TableStorage table = TableStorage::buffer;
  Evaluation evaluate = Evaluation::exact;
  TransportKind transport = TransportKind::sweep;
  Directions directions = Directions::of96;
  Directions coarser_directions = Directions::of96;
  Bounces bounces = Bounces::one;
  State state = State::coefficients;
  Layout layout = Layout::soa;
  Storage storage = Storage::float16;
  int iterations = 8;
  int grid = 32;
  int cascades = 3;
  double cascade_size = 12.5;
  int rsm_size = 256;
  RsmFormat rsm_format = RsmFormat::float32;
  int shadow_size = 1024;
  bool occlusion = true;
  Blockers blockers = Blockers::scene;
  Blocking blocking = Blocking::areas;
  int blocker_stride = 3;
  Gathering gather = Gathering::visible;
  double gather_offset = usual_gather_offset(Gathering::visible);
  int width = 960, height = 540;

  VolumeFormat format() const { return {layout, storage}; }
  LobeOptions lobes() const { return {lobe, table_size, evaluate == Evaluation::table}; }
};

/// The basis and the transport they ask for. Throw as make_basis and load_basis do.
std::unique_ptr<Basis> make_basis(const RenderOptions& options);
Transport make_transport(const RenderOptions& options, const Basis& basis);

/// All options with their present values, in the order of --help.
std::vector<OptionDescription> list_options(const RenderOptions& options);

/// Sets one option from text; `preset` sets all that presets know of, so it comes before those that override it; a
/// basis replaces a file of centres. Throws Error(usage) that names the option, the value found and the values
/// allowed: "layout: found 'planes', allowed: image|aos|soa|tiled".
void set_option(RenderOptions& options, std::string_view name, std::string_view value);

/// Every option resolved, by name: numbers, strings, and true or false.
nlohmann::json to_json(const RenderOptions& options);

}  // namespace clpv
