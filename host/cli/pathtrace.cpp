// SPDX-License-Identifier: MIT
// clpv pathtrace: path-traced ground truth for images of `render`.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "clpv/version.hpp"
#include "image/image_io.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/raster/view.hpp"
#include "quality/ground_truth.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"
#include "support/text.hpp"

namespace clpv {
namespace pathtrace_command {

struct Options : SceneRequest {
  std::string output, stats;
  std::vector<Show> views = {Show::full};
  int width = 960, height = 540;
  double time = 0;
  DisplayRequest display;
  TracingOptions tracing;
};

nlohmann::json resolved(const Options& options, const SceneCamera& camera) {
  nlohmann::json json = {{"scene", printable(options.scene)},
                         {"camera", camera.name},
                         {"time", options.time},
                         {"width", options.width},
                         {"height", options.height},
                         {"bounces", options.tracing.bounces},
                         {"seed", options.tracing.values.seed}};
  if (!options.model.empty()) json["model"] = printable(options.model);
  options.changes.describe(json);
  if (options.tracing.values.samples > 0) {
    json["spp"] = options.tracing.values.samples;
  } else {
    json["noise"] = options.tracing.values.noise;
  }
  return json;
}

void write_outputs(const Options& options, const SceneData& scene, const SceneCamera& camera,
                   const pathtracer::TracedImage& traced, double seconds) {
  DisplayRequest display = options.display;
  display.resolve(scene, are_exposed(options.output, options.views),
                  [&] { return traced_view(traced, Show::full); });
  const nlohmann::json asked = resolved(options, camera);
  const nlohmann::json noise =
      std::isnan(traced.noise) ? nlohmann::json() : nlohmann::json(traced.noise);
  std::vector<std::string_view> views;
  for (const Show view : options.views) views.push_back(name_of(view));
  nlohmann::json inputs = asked;
  if (are_exposed(options.output, options.views)) display.describe(inputs);
  std::map<std::string, std::string> metadata = metadata_of(inputs);
  metadata["command"] = "pathtrace";
  metadata["version"] = version();
  metadata["view"] = fmt::format("{}", fmt::join(views, ","));
  metadata["spp_traced"] = std::to_string(traced.samples);
  metadata["noise_reached"] = noise.dump();
  metadata[kViewHash] = view_hash(scene, camera, options.width, options.height);
  write_views(
      options.output, options.views, [&](Show view) { return traced_view(traced, view); }, display,
      metadata);
  if (options.stats.empty()) return;
  const nlohmann::json stats = {{"schema", 1},    {"options", asked},    {"spp", traced.samples},
                                {"noise", noise}, {"rays", traced.rays}, {"seconds", seconds}};
  write_file(options.stats, stats.dump(2) + "\n");
}

void run(const Options& options, Shared& shared) {
  Ranks& ranks = shared.ranks();
  pathtracer::PathTracerOptions tracing = options.tracing.resolved();
  for (const Show view : options.views) require_traceable(view);
  if (std::ranges::none_of(options.views, needs_paths)) tracing.samples = 1;
  std::vector<NamedFile> outputs = view_files(options.output, options.views);
  outputs.push_back({"--stats", options.stats});
  check_outputs(outputs);
  MovingScene moving = options.open();
  check_outputs(outputs);
  for (const std::string& note : moving.scene().notes) log_info("{}", note);
  moving.pose(options.time);
  const SceneData& scene = moving.scene();
  const SceneCamera& camera = scene.camera(options.camera);
  const auto started = std::chrono::steady_clock::now();
  Progress progress("path tracing", kTraceSteps);
  const pathtracer::TracedImage traced = pathtracer::trace_paths(
      scene, scene.lights_for(camera), camera_view(camera, options.width, options.height), tracing,
      trace_progress(progress), ranks);
  if (!ranks.is_root()) return;
  const double seconds = ms_since(started) / 1000;
  if (options.tracing.values.samples == 0 && traced.noise > options.tracing.values.noise) {
    log_warning("noise {:.4f} after the maximum of {} paths per pixel; requested: {}", traced.noise,
                traced.samples, options.tracing.values.noise);
  }
  write_outputs(options, scene, camera, traced, seconds);
  const std::string noise =
      std::isnan(traced.noise) ? "" : fmt::format("noise {:.4f}, ", traced.noise);
  log_info("{} paths per pixel, {}{:.1f} s", traced.samples, noise, seconds);
}

void add_options(CLI::App& command, Options& options) {
  add(command, "-o,--output", "FILE", options.output,
      "output image: .exr (linear) or .png (tone-mapped, sRGB)")
      ->required();
  add_scene_request(command, options);
  add_seconds(command, "--time", options.time, "time in the scene's animation [s]");
  std::vector<std::string> traceable = names_of<Show>();
  std::erase(traceable, name_of(Show::cells));
  add_choices(command, "--view", options.views,
              "views to write; several become layers of one EXR, or FILE.VIEW.png", traceable)
      ->default_str("full");
  add_number(command, "--width", "N", options.width, "image width [pixels]", {1, kMaxPixels});
  add_number(command, "--height", "N", options.height, "image height [pixels]", {1, kMaxPixels});
  add_size(command, [&options](int width, int height) {
    options.width = width;
    options.height = height;
  });
  add_display_options(command, options.display);
  add_tracing_options(command, options.tracing);
  add(command, "--stats", "FILE.json", options.stats,
      "output file for paths, noise, rays and time [s], as JSON");
}

}  // namespace pathtrace_command

void add_pathtrace(CLI::App& app, Shared& shared) {
  using namespace pathtrace_command;
  CLI::App* command =
      app.add_subcommand("pathtrace", "Ground truth of a scene by path tracing on the CPU");
  auto options = std::make_shared<pathtrace_command::Options>();
  add_options(*command, *options);
  command->footer(
      "Diffuse surfaces, hard shadows, one ray per pixel through its centre. `clpv compare` "
      "compares a rendered\n"
      "image with the result pixel by pixel. Emissive surfaces are light sources. Background "
      "pixels are 0 with alpha 0 without a sky.\n"
      "Time is proportional to the number of pixels: 240 x 135 pixels suffice for measurements.\n"
      "mpirun -n N clpv pathtrace ... traces with N ranks; the files are identical "
      "(docs/scale.md).");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
