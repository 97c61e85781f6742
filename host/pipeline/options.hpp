// Every choice that shapes a rendered frame: one table for the command line, --stats, image metadata and
// presets.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "basis/rotated_lobe.hpp"
#include "image/tone_map.hpp"
#include "pipeline/lookup_table.hpp"
#include "pipeline/run_time_lobes.hpp"
#include "pipeline/transport_source.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

enum class RsmFormat { float32, paper };  ///< paper: 32-bit depth, 8-bit normal and flux

/// The defaults are the preset `best`, and stand here alone: what comes closest to path tracing at about the
/// published scheme's cost (docs/method.md, 'Two ways to use clpv').
struct RenderOptions {
  std::string preset = "best";  ///< the one set last; options set after it may differ from it
  std::string basis = "bins24";
  std::string centres;  ///< file of an SRBF set that replaces `basis`; none: empty
  double lambda = 0.25;
  std::string lobe = "exact";
  std::string lobe_time = "host";
  int table_size = 256;
  std::string table = "buffer";
  std::string evaluate = "exact";
  std::string transport = "semi-lagrangian";
  std::string state = "coefficients";
  std::string layout = "soa", storage = "half";
  int iterations = 8;
  int grid = 32;
  int cascades = 3;
  double cascade_size = 12.5;
  int rsm_size = 256;
  std::string rsm_format = "float";
  int shadow_size = 1024;
  bool occlusion = true;
  std::string blocking = "areas";
  int blocker_stride = 3;
  std::string injection = "nearest";
  double gather_offset = 0.5;
  double gather_floor = 0;
  bool late_light = true;
  int width = 960, height = 540;

  RsmFormat rsm() const { return rsm_format == "paper" ? RsmFormat::paper : RsmFormat::float32; }
  VolumeFormat format() const { return volume_format(layout, storage); }
  LobeOptions lobes() const { return {lobe_kind(lobe), table_size, evaluate == "table"}; }
  Blocking blocked_by() const { return blocking_named(blocking); }
  LobeTime lobes_made() const { return lobe_time == "kernel" ? LobeTime::kernel : LobeTime::host; }
  TableStorage table_storage() const { return table == "image" ? TableStorage::image : TableStorage::buffer; }
  State travelling() const { return state == "fluxes" ? State::fluxes : State::coefficients; }
};

/// The basis they ask for. Throws as make_basis and load_basis do.
std::unique_ptr<Basis> make_basis(const RenderOptions& options);

/// What a user is told of one option.
struct OptionInfo {
  std::string name;     ///< long name without dashes: "cascade-size"
  std::string help;     ///< with the unit
  std::string allowed;  ///< "on|off", "1..512"
  std::string value;    ///< as text, of the given options
};

/// All options with their present values, in the order of --help.
std::vector<OptionInfo> list_options(const RenderOptions& options);

/// Sets one option from text; `preset` sets all that presets know of, so it comes before those that override it; a
/// basis replaces a file of centres. Throws Error(usage) that names the option, the value found and the values
/// allowed.
void set_option(RenderOptions& options, std::string_view name, std::string_view value);

/// Every option resolved, by name: numbers, strings, and true or false.
nlohmann::json to_json(const RenderOptions& options);

}  // namespace clpv
