// SPDX-License-Identifier: MIT
// clpv bake: light probes on a grid, in files that engines load.
//
//   grid, source  ->  integrals of arriving light per probe, block by block (bake/probe_source.hpp)
//   integrals     ->  coefficients of a format; probes inside walls filled (bake/bake.hpp)
//   coefficients  ->  .ktx2 (bake/ktx2.hpp) or .npz, and .json beside it; or errors (--check)
#include "bake/bake.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "bake/ktx2.hpp"
#include "bake/probe_check.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "clpv/version.hpp"
#include "scene/bounds.hpp"
#include "scene/emission.hpp"
#include "scene/load.hpp"
#include "support/array_files.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/input_file.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/print.hpp"
#include "support/progress.hpp"
#include "support/text.hpp"

namespace clpv {

enum class BakeSource { sweep, pathtrace };

template <>
inline constexpr auto kNames<BakeSource> = name_list("sweep", "pathtrace");

namespace bake_command {

using namespace bake;

constexpr double kMaxProbes = 1 << 22;
constexpr double kMaxBytes = 1 << 30;  // of all coefficients, as 32-bit floats
constexpr int kDefaultProbes = 16;     // along the longest edge
constexpr std::size_t kMaxChecked = 1 << 16;

struct Options {
  RenderRequest request;
  TracingOptions tracing;
  BakeSource from = BakeSource::sweep;
  std::string output, bounds, probes, format = "ambient-cube";
  double spacing = 0, time = 0;
  bool direct = false, no_dilate = false;
  std::size_t check = 0;
  std::vector<CLI::Option*> of_paths = {};  ///< without effect on swept light
};

std::string suffix_of(const Options& options) {
  return std::filesystem::path(options.output).extension().string();
}

/// `count` numbers between commas. Throws Error(usage).
template <typename Number>
std::vector<Number> numbers_of(const std::string& option, std::string text, std::size_t count,
                               const char* allowed) {
  std::vector<Number> numbers;
  const std::string given = text;
  for (std::size_t end = 0; end != std::string::npos; text.erase(0, end + 1)) {
    end = text.find(',');
    const auto value = parse_number<Number>(trimmed(std::string_view(text).substr(0, end)));
    if (value) numbers.push_back(*value);
    if (!value || numbers.size() > count || end == std::string::npos) break;
  }
  const auto commas = static_cast<std::size_t>(std::ranges::count(given, ','));
  if (numbers.size() != count || commas + 1 != count)
    throw Error(ExitCode::usage, "{}: found '{}', allowed: {}", option, given, allowed);
  return numbers;
}

/// Sets the positions of the outermost probes.
void set_bounds(const Options& options, const SceneData& scene, ProbeGrid& grid) {
  grid.lower = glm::dvec3(scene.lower), grid.upper = glm::dvec3(scene.upper);
  if (options.bounds.empty()) return;
  const auto n = numbers_of<double>("--bounds", options.bounds, 6,
                                    "six numbers between commas, the lower and the upper corner");
  grid.lower = {n[0], n[1], n[2]}, grid.upper = {n[3], n[4], n[5]};
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.lower[axis] < grid.upper[axis] &&
        std::max(std::abs(grid.lower[axis]), std::abs(grid.upper[axis])) <= bounds::kCoordinate)
      continue;
    throw Error(ExitCode::usage,
                "--bounds: found {} to {} along {}, allowed: a lower and a larger number, within "
                "+-{} m",
                grid.lower[axis], grid.upper[axis], "xyz"[axis], bounds::kCoordinate);
  }
}

/// The grid, within the limits of memory. Throws Error(usage).
ProbeGrid grid_of(const Options& options, const SceneData& scene, std::size_t numbers) {
  ProbeGrid grid;
  set_bounds(options, scene, grid);
  const glm::dvec3 edges = grid.upper - grid.lower;
  std::array<double, 3> count{};
  if (!options.probes.empty()) {
    const auto n = numbers_of<int>("--probes", options.probes, 3, "three numbers between commas");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (n[axis] < 1)
        throw Error(ExitCode::usage, "--probes: found {}, allowed: 1 or more along each axis",
                    n[axis]);
      count[axis] = n[axis];
    }
  } else {
    const double longest = std::max({edges.x, edges.y, edges.z}),
                 spacing = options.spacing > 0 ? options.spacing : longest / (kDefaultProbes - 1);
    for (int axis = 0; axis < 3; ++axis)
      count[static_cast<std::size_t>(axis)] =
          spacing > 0 ? std::max(2.0, std::round(edges[axis] / spacing) + 1) : 2.0;
  }
  const double all = count[0] * count[1] * count[2],
               bytes = all * 12 * static_cast<double>(numbers);
  if (!(all <= kMaxProbes && bytes <= kMaxBytes))
    throw Error(ExitCode::usage,
                "probes: found {:.0f} x {:.0f} x {:.0f}, {:.4g} MiB of coefficients; allowed: at "
                "most {:.0f} probes and {:.0f} MiB",
                count[0], count[1], count[2], bytes / (1 << 20), kMaxProbes, kMaxBytes / (1 << 20));
  for (std::size_t axis = 0; axis < 3; ++axis)
    grid.count[static_cast<int>(axis)] = static_cast<int>(count[axis]);
  return grid;
}

/// Options of frames, without the near field, which only pixels of a camera have.
RenderOptions frame_options(const Options& options, const SceneData& scene) {
  RenderRequest request = options.request;
  request.frame.emplace("near", "off");
  request.frame["bounces"] = options.tracing.bounces;
  return resolve_request(request, scene);
}

/// Where the light comes from, and what it holds while it works.
struct Light {
  std::unique_ptr<pathtracer::PointTracer> tracer;
  std::unique_ptr<Session> session;
  std::unique_ptr<ProbeSource> source;
};

Light light_from(const Options& options, const SceneData& scene, const SceneCamera& camera,
                 const ProbeGrid& grid, const std::vector<ProbeFormat>& formats,
                 const Shared& shared) {
  Light light;
  light.tracer = std::make_unique<pathtracer::PointTracer>(scene, scene.lights_for(camera),
                                                           options.tracing.resolved());
  if (options.from == BakeSource::pathtrace) {
    light.source = traced_light(*light.tracer, grid, formats, options.tracing.values.samples > 0);
    return light;
  }
  const Device device = choose_device(shared.device);
  light.session = std::make_unique<Session>(device, ProgramCache::of_user(device),
                                            compilation_of(options.request, shared.device));
  light.source =
      swept_light(*light.session, scene, camera, frame_options(options, scene), grid, formats);
  return light;
}

/// Everything that the light of a bake depends on.
std::string key_of(const Options& options, const SceneData& scene, const SceneCamera& camera,
                   const ProbeGrid& grid) {
  const pathtracer::PathTracerOptions paths = options.tracing.resolved();
  Fingerprint print;
  print.add(program_fingerprint()).add(scene_fingerprint(scene)).add(options.format);
  for (const SceneLight& light : scene.lights_for(camera)) print.add(std::vector{light.data});
  print.add(std::vector{grid.lower, grid.upper}).add(std::vector{grid.count});
  print.add(name_of(options.from)).add(paths.bounces);
  if (options.from == BakeSource::pathtrace)
    print.add(paths.seed).add(paths.samples).add(paths.samples > 0 ? 0.0 : paths.noise);
  for (const auto& [name, value] : options.request.frame) print.add(name).add(value);
  return print.hex();
}

GridLight computed(const Options& options, Light& light, const ProbeGrid& grid,
                   const std::vector<ProbeFormat>& formats, BlockCache& cache) {
  const Moments moments = joined(formats);
  GridLight all;
  {
    Progress progress("baking", light.source->blocks().size());
    all = light_of(*light.source, grid, moments.count, cache,
                   [&](std::size_t done) { progress.reach(done); });
  }
  if (light.session) light.session->store_programs();
  if (options.direct) {
    const std::vector<glm::dvec3> direct = light.tracer->direct(positions_of(grid), moments);
    for (std::size_t i = 0; i < direct.size(); ++i) all.integrals[i] += glm::vec3(direct[i]);
  }
  return all;
}

std::string row_of(const ProbeFormat& format, const BakedProbes& baked, const CheckPoints& surfaces,
                   const CheckPoints& air) {
  const ProbeError on = error_of(format, baked, surfaces, kSurfaceLift),
                   off = error_of(format, baked, air, 0);
  return fmt::format("{:<18}{:>8}{:>7}{:>10.1f}{:>9.3f}{:>9.1f}{:>9.3f}{:>11.1f}\n", format.name,
                     format.size, 6 * format.size, 100 * on.nrmse, on.energy, 100 * off.nrmse,
                     off.energy, 100 * off.negative);
}

/// Prints the errors of all formats.
void check(const Options& options, const SceneData& scene, const SceneCamera& camera,
           const Shared& shared) {
  std::vector<ProbeFormat> formats;
  std::size_t numbers = 0;
  for (const std::string& name : probe_format_names()) {
    formats.push_back(probe_format(name));
    numbers += formats.back().moments.count;
  }
  const ProbeGrid grid = grid_of(options, scene, numbers);
  Light light = light_from(options, scene, camera, grid, formats, shared);
  BlockCache none(std::nullopt, "");
  const GridLight all = computed(options, light, grid, formats, none);
  const std::vector<std::uint8_t> valid = validity(*light.tracer, positions_of(grid));
  double noise[2] = {};
  const CheckPoints surfaces = surface_points(*light.tracer, grid, options.check, options.direct,
                                              noise[0]),
                    air = air_points(*light.tracer, grid, options.check, options.direct, noise[1]);
  std::string text =
      fmt::format("{:<18}{:>8}{:>7}{:>10}{:>9}{:>9}{:>9}{:>11}\n", "format", "numbers", "bytes",
                  "surface %", "energy", "air %", "energy", "negative %");
  std::size_t first = 0;
  for (const ProbeFormat& format : formats) {
    text +=
        row_of(format, encoded(format, all, first, grid, valid, !options.no_dilate), surfaces, air);
    first += format.moments.count;
  }
  print_text(text);
  const glm::dvec3 spacing = grid.spacing();
  spdlog::info(
      "{} x {} x {} probes, {:.3g} x {:.3g} x {:.3g} m apart; {} points of surfaces and {} in the "
      "air, noise {:.4f} and {:.4f}",
      grid.count.x, grid.count.y, grid.count.z, spacing.x, spacing.y, spacing.z,
      surfaces.points.size(), air.points.size() / 6, noise[0], noise[1]);
}

nlohmann::json array_of(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// The description beside the file.
nlohmann::json described(const Options& options, const SceneData& scene, const ProbeFormat& format,
                         const BakedProbes& baked, const GridLight& light, double intensity) {
  const ProbeGrid& grid = baked.grid;
  const glm::dvec3 middle = (grid.lower + grid.upper) / 2.0, edges = grid.upper - grid.lower,
                   spacing = grid.spacing();
  const auto invalid = std::ranges::count(baked.valid, 0);
  nlohmann::json json = {{"schema", 1},
                         {"command", "bake"},
                         {"version", version()},
                         {"scene", printable(options.request.scene)},
                         {"scene_hash", scene_fingerprint(scene)},
                         {"time", options.time},
                         {"format", format.name},
                         {"numbers", format.size},
                         {"meaning", format.meaning},
                         {"from", name_of(options.from)},
                         {"bounces", options.tracing.bounces},
                         {"direct", options.direct},
                         {"probes", {grid.count.x, grid.count.y, grid.count.z}},
                         {"bounds", {array_of(grid.lower), array_of(grid.upper)}},
                         {"spacing", array_of(spacing)},
                         {"invalid", invalid},
                         {"dilated", baked.filled && invalid > 0},
                         {"negative", baked.negative},
                         {"intensity", intensity}};
  if (options.from == BakeSource::pathtrace) {
    json["spp"] = light.samples;
    json["noise"] = std::isnan(light.noise) ? nlohmann::json() : nlohmann::json(light.noise);
    json["seed"] = options.tracing.values.seed;
  }
  if (suffix_of(options) != ".ktx2") return json;
  if (format.size == 6) {
    json["bevy"] = {{"translation", array_of(middle)}, {"scale", array_of(edges + spacing)}};
  } else {
    json["three"] = {{"position", array_of(middle)},
                     {"width", edges.x},
                     {"height", edges.y},
                     {"depth", edges.z}};
  }
  return json;
}

std::string npz_of(const ProbeFormat& format, const BakedProbes& baked) {
  const ProbeGrid& grid = baked.grid;
  const auto x = static_cast<std::size_t>(grid.count.x), y = static_cast<std::size_t>(grid.count.y),
             z = static_cast<std::size_t>(grid.count.z);
  std::vector<float> positions, coefficients, valid(baked.valid.begin(), baked.valid.end());
  const auto add = [](std::vector<float>& to, const glm::vec3& v) {
    to.insert(to.end(), {v.x, v.y, v.z});
  };
  for (const glm::dvec3& p : positions_of(grid)) add(positions, glm::vec3(p));
  for (const glm::vec3& c : baked.coefficients) add(coefficients, c);
  std::vector<float> corners, spacing;
  add(corners, glm::vec3(grid.lower)), add(corners, glm::vec3(grid.upper));
  add(spacing, glm::vec3(grid.spacing()));
  using Shape = std::vector<std::size_t>;
  return npz_bytes({{"position", npy_bytes(positions, Shape{z, y, x, 3})},
                    {"coefficients", npy_bytes(coefficients, Shape{z, y, x, format.size, 3})},
                    {"validity", npy_bytes(valid, Shape{z, y, x})},
                    {"bounds", npy_bytes(corners, Shape{2, 3})},
                    {"spacing", npy_bytes(spacing, Shape{3})},
                    {"format", npy_bytes(format.name)},
                    {"meaning", npy_bytes(format.meaning)}});
}

std::string description_file(const Options& options) {
  return options.output.empty() ? "" : options.output + ".json";
}

/// Writes both files, or none.
void write(const Options& options, const std::string& bytes, const nlohmann::json& description) {
  OutputFile data(options.output), text(description_file(options));
  const std::string json = description.dump(2) + "\n";
  data.write(std::as_bytes(std::span(bytes)));
  text.write(std::as_bytes(std::span(json)));
  data.commit();
  text.commit();
}

void bake_file(const Options& options, const SceneData& scene, const SceneCamera& camera,
               const Shared& shared) {
  const std::vector<ProbeFormat> formats{probe_format(options.format)};
  const ProbeFormat& format = formats[0];
  const bool ktx2 = suffix_of(options) == ".ktx2";
  const ProbeGrid grid = grid_of(options, scene, std::max(format.size, format.moments.count));
  if (ktx2) texture_size(format, grid);  // throws
  Light light = light_from(options, scene, camera, grid, formats, shared);
  BlockCache cache(user_cache_folder(), key_of(options, scene, camera, grid));
  const GridLight all = computed(options, light, grid, formats, cache);
  const BakedProbes baked = encoded(
      format, all, 0, grid, validity(*light.tracer, positions_of(grid)), !options.no_dilate);
  const double intensity = ktx2 ? intensity_of(baked) : 1;
  const std::string bytes =
      ktx2 ? ktx2_bytes(texture_of(format, baked, intensity), "clpv " + version())
           : npz_of(format, baked);
  write(options, bytes, described(options, scene, format, baked, all, intensity));
  cache.clear(light.source->blocks().size());
  const auto invalid = std::ranges::count(baked.valid, 0);
  spdlog::info("{} x {} x {} probes, {} of them inside walls{}; {:.1f} % of normals negative",
               grid.count.x, grid.count.y, grid.count.z, invalid,
               invalid > 0 && baked.filled ? ", filled" : "", 100 * baked.negative);
  if (std::ranges::all_of(baked.coefficients, [](const glm::vec3& c) { return c == glm::vec3(0); }))
    spdlog::warn("{}: no light reaches a probe; all coefficients are 0", scene.path);
}

void reject_without_effect(const Options& options) {
  if (options.output.empty() && options.check == 0)
    throw Error(ExitCode::usage, "bake: found neither --output nor --check, allowed: one of them");
  if (!options.output.empty() && options.check > 0)
    throw Error(ExitCode::usage, "bake: found --output and --check, allowed: one of them");
  if (!options.output.empty()) require_extension("--output", options.output, {".ktx2", ".npz"});
  if (options.spacing > 0 && !options.probes.empty())
    throw Error(ExitCode::usage, "bake: found --spacing and --probes, allowed: one of them");
  if (options.from == BakeSource::pathtrace && !options.request.frame.empty())
    throw Error(ExitCode::usage, "--{} has no effect with --from pathtrace",
                options.request.frame.begin()->first);
  for (const CLI::Option* option : options.of_paths) {
    if (option->count() > 0 && options.from == BakeSource::sweep && options.check == 0)
      throw Error(ExitCode::usage, "{} has no effect with --from sweep", option->get_name());
  }
}

void run(const Options& options, const Shared& shared) {
  reject_without_effect(options);
  probe_format(options.format);  // throws
  const std::vector<NamedFile> outputs{{"--output", options.output},
                                       {"--output", description_file(options)}};
  check_outputs(outputs);
  MovingScene moving = options.request.open();
  moving.pose(options.time);
  check_outputs(outputs);
  const SceneData& scene = moving.scene();
  for (const std::string& note : scene.notes) spdlog::info("{}", note);
  const SceneCamera& camera = scene.camera(options.request.camera);
  if (options.check > 0) {
    check(options, scene, camera, shared);
  } else {
    bake_file(options, scene, camera, shared);
  }
}

void add_options(CLI::App& command, Options& options) {
  add(command, "-o,--output", "FILE", options.output,
      "output file: .ktx2 (a 3-D texture of ambient cubes for Bevy, or of sh3 for three.js) or "
      ".npz; FILE.json\ndescribes it");
  add(command, "--format", "NAME", options.format,
      fmt::format("format of a probe: {}", fmt::join(probe_format_names(), ", ")));
  add(command, "--bounds", "X,Y,Z,X,Y,Z", options.bounds,
      "positions of the outermost probes [m]: lower and upper corner (default: the scene's box)");
  add_number(command, "--spacing", "M", options.spacing,
             "distance of neighbouring probes [m], rounded so that they fill the bounds (default: "
             "16 probes along the longest edge)",
             {bounds::kMinLength, bounds::kCoordinate});
  add(command, "--probes", "NX,NY,NZ", options.probes, "number of probes along each axis");
  add_choice(command, "--from", options.from,
             "source of light: volumes of frames that cover the bounds, or path tracing");
  command.add_flag("--direct", options.direct,
                   "with light that comes straight from the scene's lights; emissive surfaces and "
                   "the sky always count");
  command.add_flag("--no-dilate", options.no_dilate,
                   "keeps the light of probes inside walls, in place of that of their neighbours");
  add_number(command, "--check", "N", options.check,
             "prints errors of all formats at N points of surfaces and N in the air, in place of "
             "a file",
             {1, static_cast<double>(kMaxChecked)});
  add_seconds(command, "--time", options.time, "time in the scene's animation [s]");
  add_tracing_options(command, options.tracing);
  for (const char* name : {"--spp", "--noise", "--seed"})
    options.of_paths.push_back(command.get_option(name));
  add_render_request(command, options.request);
}

}  // namespace bake_command

void add_bake(CLI::App& app, Shared& shared) {
  using namespace bake_command;
  CLI::App* command =
      app.add_subcommand("bake", "Bake light probes on a grid, in files that engines load");
  auto options = std::make_shared<bake_command::Options>();
  add_options(*command, *options);
  command->footer(
      "Indirect light of all lights of --camera. Probes that see the backs of surfaces around them "
      "are inside walls.\nAn interrupted bake goes on where it was. Layouts, formats and their "
      "errors: docs/bake.md.");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
