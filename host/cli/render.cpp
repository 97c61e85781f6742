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

std::vector<NamedFile> outputs_of(const Options& options) {
  std::vector<NamedFile> outputs = view_files(options.output, options.views);
  if (options.stats != "-") outputs.push_back({"--stats", options.stats});
  return outputs;
}

void run(const Options& options, const Shared& shared) {
  const std::vector<NamedFile> outputs = outputs_of(options);
  check_outputs(outputs);
  FrameStats stats;
  const int timed = options.stats.empty() ? 0 : options.frames;
  Progress progress("render", 4 + static_cast<std::uint64_t>(timed));
  RenderRequest request = options.request;
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

  const auto image_of = [&](Show view) { return view_image(frame, view); };
  request.display.resolve(scene, are_exposed(options.output, options.views),
                          [&] { return image_of(Show::full); });
  const nlohmann::json described = describe(request, resolved, camera, options.time);
  std::map<std::string, std::string> metadata = metadata_of(described);
  if (std::ranges::count(options.views, Show::indirect) > 0)  // as of its ground truth
    metadata[kViewHash] = view_hash(scene, camera, resolved.width, resolved.height);
  write_views(options.output, options.views, image_of, request.display, metadata);
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
  add_display_options(*command, options->request.display);
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
             "number of timed frames for --stats, after a warm-up frame; medians are reported",
             {1, 1000});
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
