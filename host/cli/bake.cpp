// SPDX-License-Identifier: MIT
// clpv bake: light probes on a grid, in files that engines load.
//
//   grid, source  ->  integrals of arriving light per probe, block by block (bake/bake.hpp)
//   integrals     ->  coefficients of a format; probes inside walls filled (bake/bake.hpp)
//   coefficients  ->  .ktx2 (bake/ktx2.hpp) or .npz, and .json beside it; or errors (--check)
#include "bake/bake.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "bake/ktx2.hpp"
#include "cli/bake_parts.hpp"
#include "cli/commands.hpp"
#include "device/result_keys.hpp"
#include "scene/bounds.hpp"
#include "scene/input.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/input_file.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace bake_command {

constexpr std::size_t kMaxChecked = 1 << 16;
constexpr double kCoarse = 2;  // cells of so many spacings get a warning

/// Edge of a cell of the finest cascade [m].
double cell_of(const RenderOptions& frame) {
  return frame.cascade_size / frame.grid;
}

/// Along axes of several probes; infinite without one.
double least_spacing(const ProbeGrid& grid) {
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    if (grid.count[axis] > 1) least = std::min(least, grid.spacing()[axis]);
  return least;
}

RenderOptions frame_options(const Options& options, const SceneData& scene, const ProbeGrid& grid) {
  RenderRequest request = options.request;
  request.frame.emplace("near", "off");
  request.frame["bounces"] = options.tracing.bounces;
  RenderOptions frame = setup_of(request, scene).options;
  if (scene.cascade_size || scene.cascades || request.frame.contains("cascade-size") ||
      request.frame.contains("cascades"))
    return frame;
  while (cell_of(frame) > least_spacing(grid) && frame.cascades < kMaxCascades)
    frame.cascade_size /= 2, ++frame.cascades;
  return frame;
}

/// Where the light comes from, and what it holds while it works.
struct Light {
  std::unique_ptr<pathtracer::PointTracer> tracer;
  std::unique_ptr<Session> session;
  RenderOptions frame;  ///< options of a sweep
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
  const RenderOptions& frame = light.frame = frame_options(options, scene, grid);
  light.session = std::make_unique<Session>(device, ProgramCache::of_user(device),
                                            compilation_of(options.request, frame, shared.device));
  if (cell_of(frame) > kCoarse * least_spacing(grid))
    log_warning(
        "cells of {:.3g} m are far larger than the spacing of probes, {:.3g} m, and inexact in "
        "small rooms; a smaller --cascade-size or --from pathtrace is better",
        cell_of(frame), least_spacing(grid));
  light.source = swept_light(*light.session, scene, camera, frame, grid, formats, *light.tracer);
  return light;
}

/// Everything that the light of a bake depends on.
std::string key_of(const Options& options, const SceneData& scene, const SceneCamera& camera,
                   const ProbeGrid& grid, const Light& light) {
  const pathtracer::PathTracerOptions paths = options.tracing.resolved();
  Fingerprint print;
  print.add(program_fingerprint()).add(scene_fingerprint(scene)).add(options.format);
  for (const SceneLight& each : scene.lights_for(camera)) print.add(std::vector{each.data});
  print.add(std::vector{grid.lower, grid.upper}).add(std::vector{grid.count});
  print.add(name_of(options.from)).add(paths.bounces);
  if (options.from == BakeSource::pathtrace) {
    print.add(paths.seed).add(paths.samples).add(paths.samples > 0 ? 0.0 : paths.noise);
  } else {
    print.add(pixels_key(light.session->device(), light.frame));
  }
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
  if (light.session) light.session->programs().store();
  if (options.direct) {
    const std::vector<glm::dvec3> direct = light.tracer->direct(positions_of(grid), moments);
    for (std::size_t i = 0; i < direct.size(); ++i) all.integrals[i] += glm::vec3(direct[i]);
  }
  return all;
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
  std::vector<SurfacePoint> given;
  if (!options.points.empty()) {
    given = read_points(options.points);
    if (given.empty() || given.size() > pathtracer::kMaxTracedPoints)
      throw Error(ExitCode::bad_input, "{}: found {} points, allowed: 1 to {}", options.points,
                  given.size(), pathtracer::kMaxTracedPoints);
  }
  const ProbeGrid grid = grid_of(options, scene, numbers);
  Light light = light_from(options, scene, camera, grid, formats, shared);
  BlockCache none(std::nullopt, "");
  const GridLight all = computed(options, light, grid, formats, none);
  const std::vector<std::uint8_t> valid = validity(*light.tracer, positions_of(grid));
  const Check check(options, *light.tracer, grid, std::move(given));
  std::string text = check.header();
  std::size_t first = 0;
  for (const ProbeFormat& format : formats) {
    text += check.row(format, encoded(format, all, first, grid, valid, !options.no_dilate,
                                      options.tracing.values.threads));
    first += format.moments.count;
  }
  print_text(text);
  check.report(grid);
}

void bake_file(const Options& options, const SceneData& scene, const SceneCamera& camera,
               const Shared& shared) {
  const std::vector<ProbeFormat> formats{probe_format(options.format)};
  const ProbeFormat& format = formats[0];
  const ProbeGrid grid = grid_of(options, scene, std::max(format.size, format.moments.count));
  if (suffix_of(options) == ".ktx2") texture_size(format, grid);  // throws
  Light light = light_from(options, scene, camera, grid, formats, shared);
  BlockCache cache(user_cache_folder(), key_of(options, scene, camera, grid, light));
  BakedProbes baked;
  std::optional<Check> check;
  try {
    const GridLight all = computed(options, light, grid, formats, cache);
    baked = encoded(format, all, 0, grid, validity(*light.tracer, positions_of(grid)),
                    !options.no_dilate, options.tracing.values.threads);
    if (options.check > 0) check.emplace(options, *light.tracer, grid);
    write_probes(options, scene, format, baked, all, check ? check->error(format, baked) : nullptr);
  } catch (const Interrupted& interrupted) {
    throw Interrupted(cache.keeps() ? "the same command goes on where it was" : interrupted.what());
  }
  cache.clear(light.source->blocks().size());
  if (check) {
    print_text(check->header() + check->row(format, baked));
    check->report(grid);
  }
  const auto invalid = std::ranges::count(baked.valid, 0);
  log_info("{} x {} x {} probes, {} of them inside walls{}; {:.1f} % of normals negative",
           grid.count.x, grid.count.y, grid.count.z, invalid,
           invalid > 0 && baked.filled ? ", filled" : "", 100 * baked.negative);
  if (invalid == std::ranges::ssize(baked.valid)) {
    log_warning(
        "{}: all probes are inside walls, as they see backs of surfaces: --bounds and the "
        "model's winding decide",
        scene.path);
  } else if (std::ranges::all_of(baked.coefficients,
                                 [](const glm::vec3& c) { return c == glm::vec3(0); })) {
    log_warning("{}: no light reaches a probe; all coefficients are 0", scene.path);
  }
}

void reject_without_effect(const Options& options) {
  const bool points = !options.points.empty();
  if (options.output.empty() && options.check == 0 && !points)
    throw Error(ExitCode::usage,
                "bake: found none of --output, --check and --points, allowed: one of them");
  if (points && (!options.output.empty() || options.check > 0))
    throw Error(ExitCode::usage, "bake: found --points and --{}, allowed: one of them",
                options.check > 0 ? "check" : "output");
  if (!options.output.empty()) require_extension("--output", options.output, {".ktx2", ".npz"});
  if (options.spacing > 0 && !options.probes.empty())
    throw Error(ExitCode::usage, "bake: found --spacing and --probes, allowed: one of them");
  if (options.from == BakeSource::pathtrace && !options.request.frame.empty())
    throw Error(ExitCode::usage, "--{} has no effect with --from pathtrace",
                options.request.frame.begin()->first);
  for (const CLI::Option* option : options.of_paths) {
    if (option->count() > 0 && options.from == BakeSource::sweep && options.check == 0 && !points)
      throw Error(ExitCode::usage, "{} has no effect with --from sweep", option->get_name());
  }
}

void run(const Options& options, const Shared& shared) {
  reject_without_effect(options);
  probe_format(options.format);  // throws
  const std::vector<NamedFile> outputs{{"--output", options.output},
                                       {"--output", description_file(options), true}};
  check_outputs(outputs);
  MovingScene moving = options.request.open();
  moving.pose(options.time);
  check_outputs(outputs);
  const SceneData& scene = moving.scene();
  for (const std::string& note : scene.notes) log_info("{}", note);
  const SceneCamera& camera = scene.camera(options.request.camera);
  if (options.output.empty()) {
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
      "positions of the outermost probes [m]: lower and upper corner (default: just inside the "
      "scene's box)");
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
                   "do not fill probes inside walls from their neighbours");
  add_number(command, "--check", "N", options.check,
             "errors at N points of surfaces and N in the air: prints those of all formats, or, "
             "with --output, those of the file, and adds them to FILE.json",
             {1, static_cast<double>(kMaxChecked)});
  add(command, "--points", "FILE.csv", options.points,
      "prints the mean irradiance of all formats at points, lines of x,y,z,nx,ny,nz");
  add_seconds(command, "--time", options.time, "time in the scene's animation [s]");
  add_tracing_options(command, options.tracing);
  for (const char* name : {"--spp", "--noise", "--seed"})
    options.of_paths.push_back(command.get_option(name));
  add_point_request(command, options.request);
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
