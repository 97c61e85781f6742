// SPDX-License-Identifier: MIT
// clpv propagate: propagation without a scene: sources and blockers in an empty grid, energy of each step.
#include "pipeline/steps/propagate.hpp"

#include <fmt/format.h>

#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "options/render_options.hpp"
#include "reference/propagate.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"
#include "volume/volume_files.hpp"

namespace clpv {
namespace propagate_command {

struct Source {
  glm::ivec3 at{0};
  std::optional<glm::dvec3> normal;  ///< none: isotropic
  glm::dvec3 flux{1};
};

/// Default options of a propagation: the published scheme, with full-precision numbers.
RenderOptions plain_options() {
  RenderOptions options;
  options.basis = "sh2";
  options.transport = TransportKind::sampled;
  options.storage = Storage::float32;
  return options;
}

/// Frame options that affect a propagation.
const std::vector<std::string>& taken_options() {
  static const std::vector<std::string> names{"basis",    "centres",    "lambda",    "lobe",  "lobe-time",
                                              "evaluate", "table-size", "transport", "state", "layout",
                                              "storage",  "iterations", "grid"};
  return names;
}

struct Options {
  RenderOptions frame = plain_options();
  bool preset_given = false;
  std::vector<Source> sources;
  std::vector<std::pair<glm::ivec3, glm::ivec3>> blocks;
  std::string npy, vti;
};

/// Coefficients of a source of 1 W: a clamped cosine about the normal, or isotropic.
std::vector<double> lobe(const Basis& basis, const Source& source) {
  std::vector<double> c = source.normal ? basis.clamped_cosine(*source.normal) : basis.constant();
  const double scale = source.normal ? 1.0 / glm::pi<double>() : 0.25 / glm::pi<double>();
  for (double& value : c) value *= scale;
  return c;
}

void require_inside(const glm::ivec3& p, int limit, const char* option) {
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] < 0 || p[axis] >= limit) {
      throw Error(ExitCode::usage, "{}: {},{},{} is outside the grid; allowed 0..{} along each axis", option,
                  p.x, p.y, p.z, limit - 1);
    }
  }
}

reference::Volume injected_light(const Basis& basis, const Options& options) {
  reference::Volume volume(options.frame.grid, basis.size());
  for (const Source& source : options.sources) {
    require_inside(source.at, options.frame.grid, "--at");
    const std::vector<double> c = lobe(basis, source);
    for (int channel = 0; channel < 3; ++channel) {
      for (int i = 0; i < basis.size(); ++i) {
        volume.at(channel, i, source.at.x, source.at.y, source.at.z) += source.flux[channel] * c[i];
      }
    }
  }
  return volume;
}

/// Full blocking in all directions: B = 1 at every named corner.
reference::Volume blocked_corners(const Basis& basis, const Options& options) {
  reference::Volume volume(options.frame.grid + 1, basis.size(), 1);
  const std::vector<double> one = basis.constant();
  for (const auto& [first, last] : options.blocks) {
    require_inside(first, options.frame.grid + 1, "--block");
    require_inside(last, options.frame.grid + 1, "--block");
    for (int z = first.z; z <= last.z; ++z) {
      for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
          for (int i = 0; i < basis.size(); ++i) volume.at(0, i, x, y, z) = one[i];
        }
      }
    }
  }
  return volume;
}

std::vector<float> to_float(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

/// Propagating light as coefficients in double precision, for any state of the device.
reference::Volume travelling_coefficients(const Basis& basis, const Transport& transport,
                                          const std::vector<float>& values, int grid, int carried) {
  reference::Volume result(grid, basis.size());
  const std::size_t plane = static_cast<std::size_t>(grid) * grid * grid;
  const auto* faces = std::get_if<FaceTransport>(&transport.scheme);
  const bool fluxes = carried != basis.size() || values.size() != result.values.size();
  if (!fluxes) result.values.assign(values.begin(), values.end());
  for (int channel = 0; fluxes && channel < 3; ++channel) {
    for (int i = 0; i < basis.size(); ++i) {
      for (std::size_t p = 0; p < plane; ++p) {
        double& out = result.values[(static_cast<std::size_t>(channel) * basis.size() + i) * plane + p];
        for (int f = 0; f < 6; ++f)
          out += faces->lobes(i, f) * values[(static_cast<std::size_t>(channel) * 6 + f) * plane + p];
      }
    }
  }
  return result;
}

nlohmann::json options_json(const Options& options) {
  nlohmann::json sources = nlohmann::json::array(), blocks = nlohmann::json::array();
  for (const Source& s : options.sources) {
    nlohmann::json normal = nullptr;
    if (s.normal) normal = {s.normal->x, s.normal->y, s.normal->z};
    sources.push_back(
        {{"at", {s.at.x, s.at.y, s.at.z}}, {"normal", normal}, {"flux", {s.flux.x, s.flux.y, s.flux.z}}});
  }
  for (const auto& [a, b] : options.blocks) blocks.push_back({{a.x, a.y, a.z}, {b.x, b.y, b.z}});
  const nlohmann::json frame = to_json(options.frame);
  nlohmann::json json = {{"preset", nullptr}, {"sources", sources}, {"blocks", blocks}};
  if (options.preset_given) json["preset"] = frame.at("preset");
  for (const std::string& name : taken_options()) json[name] = frame.at(name);
  return json;
}

void run(const Options& options, const Shared& shared) {
  check_outputs({{"--output", options.npy}, {"--vti", options.vti}}, {{"--centres", options.frame.centres}});
  if (options.sources.empty()) spdlog::warn("no light is injected: --at x,y,z names a cell to inject into");
  const RenderOptions& frame = options.frame;
  const auto basis = make_basis(frame);
  // Blockers block all directions here; stored as coefficients for any blocker option of the frame.
  const Transport transport = make_transport(frame.transport, *basis, frame.lobes(), Blocking::one_sided);
  const VolumeFormat format = frame.format();
  const reference::Volume light = injected_light(*basis, options);
  Session session(choose_device(shared.device), ProgramCache::of_user());
  const VolumeShape shape{options.frame.grid, basis->size(), 3};
  Volume injected(session, shape, "injected light", format),
      accumulated(session, shape, "accumulated light", format);
  injected.write(session, to_float(light.values));
  std::optional<Volume> corners;
  if (!options.blocks.empty()) {
    corners.emplace(session, VolumeShape{options.frame.grid + 1, basis->size(), 1}, "geometry volume",
                    format);
    corners->write(session, to_float(blocked_corners(*basis, options).values));
  }

  nlohmann::json steps = nlohmann::json::array();
  std::array<double, 3> total = reference::energy(*basis, light), lost{};
  steps.push_back({{"step", 0}, {"travelling", total}, {"accumulated", total}, {"lost", lost}});
  reference::Volume before = light;
  Propagator propagator(session, *basis, transport, propagate_options(frame));
  propagator.propagate(
      {injected, corners ? &*corners : nullptr, accumulated}, options.frame.iterations,
      [&](int step, const Volume& travelling) {
        const auto out = reference::escaping_energy(*basis, transport, before);
        before = travelling_coefficients(*basis, transport, travelling.read(session), options.frame.grid,
                                         travelling.shape().coefficients);
        const auto now = reference::energy(*basis, before);
        for (std::size_t c = 0; c < 3; ++c) {
          total[c] += now[c];
          lost[c] = out[c];
        }
        steps.push_back({{"step", step}, {"travelling", now}, {"accumulated", total}, {"lost", lost}});
      });

  const std::vector<float> values = accumulated.read(session);
  const ClpvGrid grid{{0, 0, 0}, 1, static_cast<unsigned>(options.frame.grid), {}};  // cells of 1 m
  if (!options.npy.empty()) write_volume_npy(options.npy, values, options.frame.grid, basis->size());
  if (!options.vti.empty()) write_volume_vti(options.vti, values, grid, basis->size());
  fmt::print("{}\n",
             nlohmann::json{{"schema", 1}, {"options", options_json(options)}, {"steps", steps}}.dump(2));
  session.store_programs();
}

}  // namespace propagate_command

void add_propagate(CLI::App& app, Shared& shared) {
  using namespace propagate_command;
  CLI::App* command =
      app.add_subcommand("propagate", "Propagate sources in an empty grid; energy of each step as JSON [W]");
  auto options = std::make_shared<propagate_command::Options>();
  command
      ->add_option_function<std::string>(
          "--preset",
          [options](const std::string& name) {
            set_given(options->frame, "preset", name);
            options->preset_given = true;
          },
          "preset of clpv render for basis, lambda, transport and state; explicit options override it")
      ->check(CLI::IsMember(names_of<PresetName>()));
  add_some_frame_options(*command, options->frame, taken_options());  // after the preset, which they override
  command->get_option("--centres")->excludes(command->get_option("--basis"));
  const auto last_source = [options]() -> Source& {
    if (options->sources.empty())
      throw CLI::ValidationError("--at must come before --normal, --isotropic and --flux");
    return options->sources.back();
  };
  command
      ->add_option_function<std::vector<std::string>>(
          "--at",
          [options](const std::vector<std::string>& all) {
            for (const std::string& text : all)
              options->sources.push_back({parse_ivec3(text, "--at"), std::nullopt, glm::dvec3(1)});
          },
          "cell i,j,k of a source; repeatable, the source options that follow apply to it")
      ->trigger_on_parse()
      ->take_all()
      ->type_name("i,j,k");
  command
      ->add_option_function<std::string>(
          "--normal",
          [last_source](const std::string& text) {
            const glm::dvec3 n = parse_dvec3(text, "--normal");
            if (!(glm::length(n) > 0))
              throw Error(ExitCode::usage, "--normal {}: length 0; allowed: any other vector", text);
            last_source().normal = glm::normalize(n);
          },
          "axis x,y,z of the source's clamped cosine (no half-cell shift)")
      ->trigger_on_parse()
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
      ->type_name("x,y,z");
  command
      ->add_flag_callback(
          "--isotropic", [last_source] { last_source().normal.reset(); }, "isotropic source (default)")
      ->trigger_on_parse();
  command
      ->add_option_function<std::string>(
          "--flux",
          [last_source](const std::string& text) { last_source().flux = parse_dvec3(text, "--flux"); },
          "flux r,g,b of the source [W] (default: 1,1,1)")
      ->trigger_on_parse()
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
      ->type_name("r,g,b");
  command
      ->add_option_function<std::vector<std::string>>(
          "--block",
          [options](const std::vector<std::string>& all) {
            for (const std::string& text : all) options->blocks.push_back(parse_box(text, "--block"));
          },
          "box of geometry samples (cell corners) i0..i1, j0..j1, k0..k1 that block fully, both ends "
          "included; repeatable")
      ->take_all()
      ->type_name("i0,j0,k0:i1,j1,k1");
  add(*command, "-o,--output", "FILE.npy", options->npy,
      "output file for accumulated light: .npy, float32, shape 3,N,z,y,x [W/sr]");
  add(*command, "--vti", "FILE.vti", options->vti,
      "output file for accumulated light: VTK ImageData, for ParaView [W/sr]");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
