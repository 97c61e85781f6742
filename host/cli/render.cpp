// SPDX-License-Identifier: MIT
// clpv render: renders an image of a scene lit by cascaded light propagation volumes.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "cli/unreached.hpp"
#include "image/image_io.hpp"
#include "pipeline/frame/frame.hpp"
#include "quality/ground_truth.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"
#include "support/print.hpp"
#include "support/progress.hpp"
#include "times/frame_stats.hpp"

namespace clpv {
namespace render_command {

namespace fs = std::filesystem;

struct Options {
  RenderRequest request;
  std::string output, stats;
  int frames = 5;
  double time = 0;
  std::vector<Show> views = {Show::full};
};

/// Returns FILE.png, or FILE.VIEW.png if there are several views.
fs::path png_path(const fs::path& output, Show view, bool several) {
  if (!several) return output;
  fs::path path = output;
  return path.replace_extension(fmt::format(".{}{}", name_of(view), output.extension().string()));
}

std::vector<NamedFile> outputs_of(const Options& options) {
  require_extension("--output", options.output, {".exr", ".png"});
  const bool several = options.views.size() > 1 && fs::path(options.output).extension() == ".png";
  std::vector<NamedFile> outputs;
  for (const Show view : options.views)
    outputs.push_back({"--output", png_path(options.output, view, several)});
  if (!several) outputs.resize(1);
  if (options.stats != "-") outputs.push_back({"--stats", options.stats});
  return outputs;
}

void write_images(Frame& frame, const Options& options, float exposure,
                  const std::map<std::string, std::string>& metadata) {
  const fs::path output = options.output;
  const std::vector<Show>& views = options.views;
  if (output.extension() == ".exr") {
    Image all;
    for (const Show view : views) {
      append_layer(all, view_image(frame, view),
                   views.size() == 1 ? std::string() : std::string(name_of(view)));
    }
    all.metadata = metadata;
    return write_exr(output, all);
  }
  for (const Show view : views) {
    Image shown = options.request.displayed(view_image(frame, view), exposure);
    shown.metadata = metadata;
    write_png(png_path(output, view, views.size() > 1), shown);
  }
}

void run(const Options& options, const Shared& shared) {
  const std::vector<NamedFile> outputs = outputs_of(options);
  check_outputs(outputs);
  FrameStats stats;
  const int timed = options.stats.empty() ? 0 : options.frames;
  Progress progress("render", 4 + static_cast<std::uint64_t>(timed));
  const RenderRequest& request = options.request;
  MovingScene moving = request.open();
  const SceneData& scene = moving.scene();
  moving.pose(options.time);
  const FrameSetup setup = setup_of(request, scene);
  const RenderOptions& resolved = setup.options;
  check_outputs(outputs);
  const SceneCamera& camera = scene.camera(request.camera);
  log_scene(scene, camera, resolved);
  progress.advance();

  stats.begin_startup();
  const Device device = choose_device(shared.device);
  Session session(device, ProgramCache::of_user(device),
                  compilation_of(request, resolved, shared.device), timed > 0);
  Frame frame(session, scene, setup);
  stats.end_startup();
  log_debug("device: {} ({}), driver {}", session.device().name, session.device().platform,
            session.device().driver);
  log_debug("options: {}", to_json(resolved).dump());
  progress.advance();
  frame.render(camera, [&](const CascadeVolumes& volumes) {
    if (!options.stats.empty()) stats.add_energy(session, frame, volumes);
  });
  stats.end_first_frame(session);
  warn_of_unreached(session, frame, camera.name);
  stop_if_interrupted();
  progress.advance();
  if (!options.stats.empty()) {
    FrameTimes times =
        measure_frames(session, frame, camera, timed, 0, [&] { progress.advance(); });
    count_chains(session, frame, camera, times);
    stats.set_times(std::move(times));
  }

  const nlohmann::json described = describe(request, resolved, scene, camera, options.time);
  std::map<std::string, std::string> metadata = metadata_of(described);
  if (std::ranges::count(options.views, Show::indirect) > 0)  // as of its ground truth
    metadata[kViewHash] = view_hash(scene, camera, resolved.width, resolved.height);
  write_images(frame, options, request.exposure_of(scene), metadata);
  if (!options.stats.empty()) {
    const std::string text = stats.to_json(session, described).dump(2) + "\n";
    if (options.stats == "-")
      print_json(text);
    else
      write_file(options.stats, text);
  }
  progress.advance();
  session.programs().store();
}

}  // namespace render_command

void add_render(CLI::App& app, Shared& shared) {
  using namespace render_command;
  CLI::App* command = app.add_subcommand(
      "render", "Render a scene with indirect light from light propagation volumes");
  auto options = std::make_shared<render_command::Options>();
  add_render_request(*command, options->request);
  add_shown_options(*command, options->request);
  add(*command, "-o,--output", "FILE", options->output,
      "output image: .exr (linear) or .png (tone-mapped, sRGB); its metadata holds the options")
      ->required();
  add_seconds(*command, "--time", options->time, "time in the scene's animation [s]");
  add_choices(*command, "--view", options->views,
              "views to write; several become layers of one EXR, or FILE.VIEW.png")
      ->default_str("full");
  add(*command, "--stats", "FILE.json", options->stats,
      "output file (-: stdout) for stage times of frames that recompute all lighting, options and "
      "energies, "
      "as JSON");
  add_number(*command, "--frames", "N", options->frames,
             "number of timed frames for --stats, after a warm-up frame; it has their medians",
             {1, 1000});
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
