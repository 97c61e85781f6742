// SPDX-License-Identifier: MIT
// clpv sequence: renders an animated scene frame by frame into a folder, and optionally into a
// video.

#include "sequence/sequence.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "image/image.hpp"
#include "pathtracer/path_tracer.hpp"
#include "scene/bounds.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/process.hpp"

namespace clpv {

namespace sequence_command {

namespace fs = std::filesystem;

// Players need even sizes and 4:2:0 chroma; x264's loss is hardly visible at CRF 18.
constexpr const char* kEncoding =
    "-vf pad=ceil(iw/2)*2:ceil(ih/2)*2 -c:v libx264 -crf 18 -pix_fmt yuv420p -movflags +faststart "
    "-f mp4 -y";

std::vector<std::uint8_t> rgb_bytes(const Image& shown) {
  const std::size_t channels = shown.channels.size();
  std::vector<std::uint8_t> bytes(3 * shown.pixel_count());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = byte_of(shown.pixels[i / 3 * channels + i % 3]);
  return bytes;
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

/// Encodes frames with ffmpeg: H.264 video in an MP4 file, an OutputFile.
class Video {
 public:
  /// Throws Error(run_time) if ffmpeg is not in the path (with what to install). Construct before
  /// the work.
  Video(fs::path file, double frames_per_second)
      : file_(std::move(file)), frames_per_second_(frames_per_second) {
    const auto found = find_program("ffmpeg");
    if (!found)
      throw Error(ExitCode::run_time,
                  "--video needs ffmpeg, which is not in PATH (Debian: ffmpeg)");
    ffmpeg_ = *found;
  }

  /// Adds a frame: display-encoded RGB or RGBA, of the size of earlier frames. This and finish()
  /// throw Error(run_time) with ffmpeg's message on failure.
  void add(const Image& shown) {
    if (!process_) {
      std::vector<std::string> words =
          words_of(fmt::format("-hide_banner -loglevel error -f rawvideo -pixel_format rgb24 "
                               "-video_size {}x{} -framerate {} -i pipe:0 {}",
                               shown.width, shown.height, frames_per_second_, kEncoding));
      part_.emplace(file_);
      // a name with a colon would be a protocol
      words.push_back("file:" + part_->temporary().string());
      process_ = std::make_unique<Process>(ffmpeg_, words, true);
    }
    const std::vector<std::uint8_t> bytes = rgb_bytes(shown);
    if (!process_->feed(std::as_bytes(std::span(bytes)))) fail(process_->end());
  }

  /// Without it, there is no video.
  void finish() {
    const Process::Result ended = process_->end();
    process_.reset();
    if (ended.code != 0) fail(ended);
    part_->commit();
  }

 private:
  [[noreturn]] void fail(const Process::Result& ended) const {
    stop_if_interrupted(fmt::format("{} was not written", file_.string()));
    throw Error(ExitCode::run_time, "{}: {} ended with {}: {}", file_.string(), ffmpeg_.string(),
                ended.code, ended.output);
  }

  fs::path file_, ffmpeg_;
  double frames_per_second_;
  std::optional<OutputFile> part_;
  std::unique_ptr<Process> process_;  ///< ends before part_, which it writes
};

constexpr int kMaxFrames = 1000000;
constexpr double kMaxFramesPerSecond = 1000;

struct Options : SequenceOptions {
  RenderRequest request;
  std::string video;
  bool stability = false;
};

/// Checks the options before the scene is read. Returns the outputs.
std::vector<NamedFile> prepare_outputs(const Options& options) {
  if (const double last = options.time_of(options.frames - 1); last > bounds::kSeconds) {
    throw Error(ExitCode::usage, "--frames {}: the last is at {} s; allowed: up to {} s",
                options.frames, last, bounds::kSeconds);
  }
  if (options.traced > 0 && !options.stability)
    throw Error(ExitCode::usage, "--traced {}: needs --stability", options.traced);
  const fs::path folder = options.folder;
  std::vector<NamedFile> outputs{{"--output", options.file(0), true},
                                 {"--output", folder / "times.jsonl", true},
                                 {"--video", options.video}};
  std::error_code unknown;
  for (int i = 1; i < options.frames; ++i)  // file(0) tells whether new files are possible
    if (fs::exists(fs::symlink_status(options.file(i), unknown)))
      outputs.push_back({"--output", options.file(i), true});
  if (options.stability) outputs.push_back({"--stability", folder / "stability.json", true});
  check_outputs(outputs);
  return outputs;
}

/// Throws Error(run_time) for a file in a frame's place that clpv did not write. In a folder with
/// times.jsonl such files are damaged frames.
void spare_files_of_others(const Options& options) {
  std::error_code unknown;
  if (fs::exists(fs::path(options.folder) / "times.jsonl", unknown)) return;
  for (int i = 0; i < options.frames; ++i) {
    const fs::path file = options.file(i);
    if (fs::exists(file, unknown) && !is_frame(file))
      throw Error(ExitCode::run_time,
                  "{}: found a file that clpv did not write; allowed: none, or a frame",
                  file.string());
  }
}

/// Warns if the folder holds frames of a longer run beyond this one's.
void warn_of_later_frames(const Options& options) {
  int last = options.frames;
  while (fs::exists(options.file(last))) ++last;
  if (last > options.frames)
    log_warning("{} also holds frames {} to {} of a longer run", options.folder, options.frames,
                last - 1);
}

void run(const Options& options, Shared& shared) {
  Ranks& ranks = shared.ranks();
  if (!options.video.empty()) require_extension("--video", options.video, {".mp4"});
  std::optional<Video> video;
  if (!options.video.empty() && ranks.is_root())
    video.emplace(options.video, options.frames_per_second);
  const OutputFolder folder("--output", options.folder);
  const std::vector<NamedFile> outputs = prepare_outputs(options);
  RenderRequest request = options.request;
  MovingScene moving = request.open();
  const FrameSetup setup = setup_of(request, moving.scene());
  check_outputs(outputs);
  InputRecord::close();  // from here on it reads its own frames
  spare_files_of_others(options);
  const Device device = ranks.device(shared.device);
  const auto camera = [&](const SceneData& scene) -> const SceneCamera& {
    return scene.camera(request.camera);
  };
  log_scene(moving.scene(), camera(moving.scene()), setup.options);
  if (!moving.moves()) log_warning("{}: nothing moves: all frames are equal", request.scene);

  SequenceSubject subject{request.camera, {}, {}, {}};
  request.display.resolve(moving.scene(), false, {});
  RenderRequest described = request;  // without the exposure of a film, which EXR files do not have
  const bool shown = options.format == FrameFormat::png || !options.video.empty();
  request.display.resolve(moving.scene(), shown && shows_light(options.view), [&] {
    Session session(device, ProgramCache::of_user(device),
                    compilation_of(request, setup.options, shared.device));
    moving.pose(options.from);
    Frame first(session, moving.scene(), setup);
    first.render(camera(moving.scene()));
    return view_image(first, Show::full);
  });
  if (options.format == FrameFormat::png) described.display = request.display;
  subject.displayed = [&](const Image& image) {
    return request.display.displayed(image, options.view);
  };
  subject.describe = [&](const SceneData& posed, double seconds) {
    return describe(described, setup.options, camera(posed), seconds);
  };
  subject.first_frame = [&](Session& session, Frame& frame) {
    warn_of_unreached(session, frame, camera(moving.scene()).name);
  };
  Sequence sequence(options, subject, moving, setup, device,
                    compilation_of(request, setup.options, shared.device), ranks);
  sequence.render();
  if (!ranks.is_root()) return;
  warn_of_later_frames(options);
  try {
    if (options.stability) sequence.measure_stability();
    if (!video) return;
    sequence.for_all_images([&](const Image& image) { video->add(image); });
    video->finish();
  } catch (const Interrupted&) {
    throw Interrupted(fmt::format("all {} frames are in {}; the same command goes on with them",
                                  options.frames, options.folder));
  }
}

}  // namespace sequence_command

void add_sequence(CLI::App& app, Shared& shared) {
  using namespace sequence_command;
  CLI::App* command = app.add_subcommand("sequence", "Render an animated scene frame by frame");
  auto options = std::make_shared<sequence_command::Options>();
  add(*command, "-o,--output", "DIR", options->folder,
      "output folder for frame-0000.exr, ... and times.jsonl; created if missing")
      ->required();
  add_number(*command, "--frames", "N", options->frames, "number of frames", {1, kMaxFrames})
      ->required();
  add_number(*command, "--fps", "RATE", options->frames_per_second,
             "frame rate [frames per second of the scene's time]",
             {std::numeric_limits<double>::min(), kMaxFramesPerSecond,
              fmt::format("more than 0, up to {}", kMaxFramesPerSecond)})
      ->required();
  add_seconds(*command, "--from", options->from, "time of the first frame [s]");
  add_choice(*command, "--view", options->view, "view of the frames");
  add_choice(*command, "--format", options->format,
             "file format of the frames: linear EXR, or tone-mapped sRGB PNG");
  add(*command, "--video", "FILE.mp4", options->video, "output video of all frames; needs ffmpeg");
  command->add_flag("--stability", options->stability,
                    "write stability.json: change of light between frames on static surfaces");
  add_number(*command, "--traced", "SPP", options->traced,
             "paths per pixel for the path-traced noise of --stability",
             {1, pathtracer::PathTracerOptions::kMaxSamples});
  add_display_options(*command, options->request.display);
  add_render_request(*command, options->request);
  command->footer(
      "Frame i shows FROM + i / RATE seconds, identical to `clpv render --time` of that time.\n"
      "Automatic exposure is that of the first frame.\n"
      "An interrupted run resumes: frames whose file is whole and has the same inputs are not "
      "rendered again.\n"
      "times.jsonl has the times of each frame, one line each, and a last line with n, min, "
      "median, "
      "mad and\n"
      "max of each stage [ms].\n"
      "mpirun -n N clpv sequence ... distributes the frames over N ranks (docs/scale.md).");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
