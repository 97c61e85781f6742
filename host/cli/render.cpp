// SPDX-License-Identifier: MIT
// clpv render: renders an image of a scene lit by cascaded light propagation volumes.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "image/image_io.hpp"
#include "pipeline/frame/frame.hpp"
#include "quality/ground_truth.hpp"
#include "scene/load.hpp"
#include "scene/motion.hpp"
#include "support/error.hpp"
#include "support/helpers.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"
#include "times/frame_times.hpp"
#include "times/time_record.hpp"

namespace clpv {

/// Returns the integral over directions summed over all cells of a light volume, per channel [W].
std::array<double, 3> volume_energy(Session& session, const Basis& basis, const Volume& volume) {
  const std::vector<float> values = volume.read(session);
  const auto plane = values.size() / 3 / static_cast<std::size_t>(basis.size());
  std::array<double, 3> energy{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t i = 0; i < basis.integrals().size(); ++i) {
      double sum = 0;
      for (std::size_t p = 0; p < plane; ++p)
        sum += values[(channel * basis.integrals().size() + i) * plane + p];
      energy[channel] += sum * basis.integrals()[i];
    }
  }
  return energy;
}

/// Statistics of one `clpv render`. Times are wall times unless the timer of a stage is "event".
struct FrameStats {
  double startup_ms = 0;  ///< until the device is open, programs are built, the scene is uploaded
  double first_frame_ms = 0;  ///< its launches compile kernels for their work-group sizes
  FrameTimes timed;           ///< frames of one camera; their medians are reported
  nlohmann::json energies = nlohmann::json::array();  ///< finest cascade first

  void add_energy(Session& session, const Frame& frame, const CascadeVolumes& volumes) {
    const auto energy = [&](const Volume& volume, const Basis& basis) {
      std::array<double, 3> stored = volume_energy(session, basis, volume);
      for (double& watts : stored) watts /= volumes.light_scale;
      return stored;
    };
    nlohmann::json row{{"cascade", volumes.cascade},
                       {"injected", energy(volumes.injected, frame.basis())},
                       {"accumulated", energy(volumes.accumulated, frame.gathered())}};
    energies.insert(energies.begin(), std::move(row));
  }

  /// Returns JSON of schema 2: device, options, times (`frame` on the host's clock, `host`: its
  /// work without waits, and the stages), kernels of one frame, timer of the stages, numbers of
  /// HostWork, first_launch_ms, build_ms, startup_ms, device_bytes, energy.
  nlohmann::json to_json(const Session& session, const nlohmann::json& options) const {
    const auto samples = [&](const auto& part) {
      std::vector<double> values;
      for (const FrameCost& cost : timed.costs()) values.push_back(part(cost));
      return values;
    };
    std::vector<TimeRecord> times = {
        time_record("frame", samples([](const FrameCost& cost) { return cost.wall_ms; })),
        time_record("host", samples([](const FrameCost& cost) { return cost.host.host_ms; }))};
    const auto of_host = [&](auto HostWork::*part) {
      return median(samples([&](const FrameCost& cost) { return cost.host.*part; }));
    };
    nlohmann::json kernels = nlohmann::json::array();
    for (const KernelTime& time : timed.kernels()) {
      kernels.push_back({{"stage", name_of(time_record(time.mark, {time.ms}))},
                         {"kernel", time.kernel},
                         {"launches", time.launches},
                         {"items", time.items},
                         {"chain", time.chain},
                         {"ms", time.ms}});
    }
    const double frame_ms = times[0].median;
    std::ranges::move(timed.stage_records(), std::back_inserter(times));
    return {{"schema", 2},
            {"device", clpv::to_json(session.device())},
            {"options", options},
            {"times", times},
            {"kernels", kernels},
            {"timer", timed.from_events() ? "event" : "wall"},
            {"launches", of_host(&HostWork::launches)},
            {"fills", of_host(&HostWork::fills)},
            {"waits", of_host(&HostWork::waits)},
            {"arguments", of_host(&HostWork::arguments)},
            {"written_bytes", of_host(&HostWork::written)},
            {"host_ms",
             {{"culling", of_host(&HostWork::culling_ms)},
              {"arguments", of_host(&HostWork::arguments_ms)},
              {"enqueueing", of_host(&HostWork::enqueueing_ms)},
              {"waiting", of_host(&HostWork::waited_ms)}}},
            {"first_launch_ms", std::max(0.0, first_frame_ms - frame_ms)},
            {"build_ms", session.programs().build_ms()},
            {"startup_ms", startup_ms},
            {"device_bytes", session.peak_device_bytes()},
            {"energy", energies}};
  }
};

namespace render_command {

namespace fs = std::filesystem;

struct Options {
  RenderRequest request;
  std::string output, stats;
  int frames = 5;
  double time = 0;
  std::vector<Show> views = {Show::full};
};

void run(const Options& options, const Shared& shared) {
  std::vector<NamedFile> outputs = view_files(options.output, options.views);
  if (options.stats != "-") outputs.push_back({"--stats", options.stats});
  check_outputs(outputs);
  FrameStats stats;
  const int timed = options.stats.empty() ? 0 : options.frames;
  const int warm_up = timed == 1 ? 1 : 0;  // a fault of the device's clock shows in two frames
  Progress progress("render", 4 + static_cast<std::uint64_t>(timed + warm_up));
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

  auto started = std::chrono::steady_clock::now();
  const Device device = choose_device(shared.device);
  Session session(device, ProgramCache::of_user(device),
                  compilation_of(request, resolved, shared.device), timed > 0);
  Frame frame(session, scene, setup);
  stats.startup_ms = ms_since(std::exchange(started, std::chrono::steady_clock::now()));
  log_debug("device: {} ({}), driver {}", session.device().name, session.device().platform,
            session.device().driver);
  log_debug("options: {}", to_json(resolved).dump());
  progress.advance();
  frame.render(camera, [&](const CascadeVolumes& volumes) {
    if (!options.stats.empty()) stats.add_energy(session, frame, volumes);
  });
  session.queue().finish();
  stats.first_frame_ms = ms_since(started);
  warn_of_unreached(session, frame, camera.name);
  stop_if_interrupted();
  progress.advance();
  if (!options.stats.empty()) {
    stats.timed =
        measure_frames(session, frame, camera, timed, warm_up, [&] { progress.advance(); });
    count_chains(session, frame, camera, stats.timed);
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

// clpv prepare: a helper process, which compiles kernels of a frame that another process is about
// to render.

namespace prepare_command {

struct Options {
  RenderRequest request;
  std::string claims;
};

/// Does everything that rendering does, but launches only the kernels of claimed programs.
void run(const Options& options, const Shared& shared) {
  become_helper();
  MovingScene moving = options.request.open();
  moving.pose(0);
  Session session(choose_device(shared.device), std::nullopt, {{}, Claims(options.claims)});
  Frame frame(session, moving.scene(), FrameSetup(options.request.frame, moving.scene()));
  frame.render(moving.scene().camera(options.request.camera));
  session.programs().mark_compiled();
}

}  // namespace prepare_command

void add_prepare(CLI::App& app, Shared& shared) {
  using namespace prepare_command;
  CLI::App* command =
      app.add_subcommand("prepare", "Compile kernels, as a helper of another process");
  command->group("");  // not for users
  auto options = std::make_shared<prepare_command::Options>();
  add_render_request(*command, options->request);
  add(*command, "--claims", "DIR", options->claims, "folder shared with other helpers")->required();
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
