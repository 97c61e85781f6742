// SPDX-License-Identifier: MIT
// clpv sequence: a scene that moves, frame by frame into a folder, and into a film.
#include <fmt/format.h>

#include <filesystem>

#include "commands/choices.hpp"
#include "commands/commands.hpp"
#include "commands/sequence_run.hpp"
#include "commands/time_option.hpp"
#include "parallel/rank_device.hpp"
#include "pathtracer/path_tracer.hpp"
#include "scene/bounds.hpp"
#include "support/error.hpp"
#include "support/output_file.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFrames = 1000000;
constexpr double kMostFramesPerSecond = 1000;

double parse_rate(const std::string& text) {
  const auto rate = parse_number<double>(text);
  if (!rate || !(*rate > 0 && *rate <= kMostFramesPerSecond)) {  // NaN is in no range
    throw Error(ExitCode::usage, "--fps: found '{}', allowed: more than 0, up to {}", text,
                kMostFramesPerSecond);
  }
  return *rate;
}

/// What can be known to be wrong before the scene is read.
void check_outputs(const SequenceOptions& options) {
  named<ToneMap>("--tonemap", options.request.tonemap);
  if (const double last = options.instant(options.frames - 1); last > bounds::kSeconds) {
    throw Error(ExitCode::usage, "--frames {}: the last is at {} s; allowed: up to {} s", options.frames,
                last, bounds::kSeconds);
  }
  if (!options.video.empty() && fs::path(options.video).extension() != ".mp4") {
    throw Error(ExitCode::usage, "--video {}: found extension '{}', allowed: .mp4", options.video,
                fs::path(options.video).extension().string());
  }
  std::error_code failed;
  const fs::path folder = options.output;
  if (fs::exists(folder, failed) && !fs::is_directory(folder, failed))
    throw Error(ExitCode::run_time, "--output {}: what is there is not a folder", options.output);
  fs::create_directories(folder, failed);
  if (failed) throw Error(ExitCode::run_time, "--output {}: {}", options.output, failed.message());
  check_writable(frame_file(folder, 0, options.format));
  check_writable(folder / "times.json");
  if (options.stability) check_writable(folder / "stability.json");
  if (options.traced > 0 && !options.stability)
    throw Error(ExitCode::usage, "--traced {}: found no --stability, whose noise it tells of; allowed: both",
                options.traced);
}

void run(const SequenceOptions& options, Shared& shared) {
  Team& team = shared.team();
  std::unique_ptr<Video> video;
  std::unique_ptr<Sequence> sequence;
  team.agree([&] {
    check_outputs(options);
    if (!options.video.empty() && team.leads())
      video = std::make_unique<Video>(options.video, options.frames_per_second);
    sequence = std::make_unique<Sequence>(options, shared, team);
  });
  tell_devices(team, sequence->device());
  sequence->run();
  if (!team.leads()) return;
  if (options.stability) sequence->measure_stability();
  if (video) sequence->film(*video);
}

}  // namespace

void add_sequence(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand("sequence", "Render a scene that moves, frame by frame");
  auto options = std::make_shared<SequenceOptions>();
  command
      ->add_option("-o,--output", options->output,
                   "folder of frame-0000.exr and so on, and of times.json; made where it is not there")
      ->required()
      ->type_name("DIR");
  command->add_option("--frames", options->frames, "how many")
      ->check(CLI::Range(1, kMostFrames))
      ->required()
      ->type_name("N");
  command
      ->add_option_function<std::string>(
          "--fps", [&rate = options->frames_per_second](const std::string& text) { rate = parse_rate(text); },
          "frames a second of the scene's time")
      ->required()
      ->type_name("RATE");
  add_seconds(*command, "--from", options->from, "the instant of the first frame [s]");
  add_choice(*command, "--view", options->view, "what frames show");
  add_choice(*command, "--format", options->format, "of frames: linear, or tone-mapped sRGB");
  command->add_option("--video", options->video, "all frames as a film too, through ffmpeg")
      ->type_name("FILE.mp4");
  command->add_flag(
      "--stability", options->stability,
      "stability.json: how light changes from frame to frame on surfaces that stay where they are");
  command
      ->add_option("--traced", options->traced,
                   "with --stability: the same of path tracing by so many paths a pixel, its noise")
      ->check(CLI::Range(1u, reference::PathTracerOptions::kMostSamples))
      ->type_name("SPP");
  add_shown_options(*command, options->request);
  add_render_request(*command, options->request);
  command->footer(
      "Frame i shows FROM + i / RATE seconds, with the pixels of `clpv render --time` of that instant. A "
      "frame "
      "whose\nfile is there and was made of the same is not rendered again, so that a run that was ended "
      "goes on "
      "where it was.\ntimes.json has the times of every frame, and of each stage the median, 95th percentile "
      "and worst [ms].\nmpirun -n N clpv sequence ... shares the frames among N ranks (docs/scale.md).");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
