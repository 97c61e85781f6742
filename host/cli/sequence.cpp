// SPDX-License-Identifier: MIT
// clpv sequence: renders an animated scene frame by frame into a folder, and optionally into a video.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "cli/sequence_report.hpp"
#include "cli/tev.hpp"
#include "cli/video.hpp"
#include "image/image_io.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/frame/frame_stats.hpp"
#include "pipeline/raster/view.hpp"
#include "quality/ground_truth.hpp"
#include "cli/unreached.hpp"
#include "scene/bounds.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {

enum class FrameFormat : unsigned { exr, png };

template <>
inline constexpr auto kNames<FrameFormat> = name_list("exr", "png");

namespace sequence_command {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kMaxFrames = 1000000;
constexpr double kMaxFramesPerSecond = 1000;
constexpr const char* kKey = "frame_key";        // metadata: the key of a frame
constexpr std::chrono::seconds kTimesEvery{10};  // interval of saving times.json

/// Frame i shows `from` + i / `frames_per_second` [s].
struct Options {
  RenderRequest request;
  std::string output, video, tev;
  int frames = 0;
  double frames_per_second = 0, from = 0;
  Show view = Show::full;
  FrameFormat format = FrameFormat::exr;
  bool stability = false;
  std::uint32_t traced = 0;

  double time_of(int frame) const { return from + frame / frames_per_second; }
  fs::path file(int frame) const {
    return fs::path(output) / fmt::format("frame-{:04}.{}", frame, name_of(format));
  }
};

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Returns true if the file holds a frame with that key. Warns about unreadable files.
bool holds_frame(const fs::path& file, const std::string& key) {
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return false;
  try {
    const std::map<std::string, std::string> metadata = read_metadata(file);
    const auto found = metadata.find(kKey);
    return found != metadata.end() && found->second == key;
  } catch (const Error& error) {
    spdlog::warn("{}; it is rendered again", error.what());
    return false;
  }
}

/// Renders the frames; scene, device and device resources persist between frames.
class Sequence {
 public:
  Sequence(const Options& options, const Shared& shared, Ranks& ranks)
      : options_(options),
        ranks_(ranks),
        moving_(options.request.open()),
        resolved_(resolve_request(options.request, moving_.scene())),
        device_(ranks.device(shared.device)),
        compilation_(compilation_of(options.request, shared.device)) {
    log_scene(moving_.scene(), camera(), resolved_);
    if (!moving_.moves()) spdlog::warn("{}: nothing moves: all frames are equal", options.request.scene);
    Fingerprint print;
    print.add(program_fingerprint()).add(device_.platform).add(device_.name).add(device_.driver);
    still_ = print.add(reference::scene_fingerprint(moving_.scene())).hex();
    if (!options.tev.empty() && ranks.is_root()) tev_.emplace(options.tev);
    if (ranks.is_root()) times_ = read_times(times_file(), options.frames);
  }

  /// Renders the missing frames of this rank; then rank 0 writes the times of all.
  void render() {
    const Clock::time_point started = Clock::now();
    double mine = 0, counts[] = {0, 0};
    auto& [rendered, there] = counts;
    for (int i = 0; i < options_.frames; ++i) mine += ranks_.takes(static_cast<std::size_t>(i));
    Progress progress("sequence", static_cast<std::uint64_t>(mine));
    for (int i = 0; i < options_.frames; ++i) {
      if (!ranks_.takes(static_cast<std::size_t>(i))) continue;
      try {
        stop_if_interrupted();
        (render(i) ? rendered : there) += 1;  // a signal may also end it where it compiles kernels
      } catch (const Interrupted&) {
        write_times();
        throw Interrupted(fmt::format("{} of {} frames are in {}; the same command resumes", rendered + there,
                                      mine, options_.output));
      }
      progress.advance();
    }
    ranks_.sum(counts);
    if (there > 0) spdlog::info("{} of {} frames existed already", there, options_.frames);
    if (rendered > 0) spdlog::info("{} frames in {:.1f} s", rendered, milliseconds_since(started) / 1000);
    for (const std::string& gathered : ranks_.gather(nlohmann::json(times_).dump()))
      for (auto& [number, frame] : nlohmann::json::parse(gathered).get<SequenceTimes>())
        times_[number] = frame;
    write_times();
    if (renderer_) renderer_->session.store_programs();
    renderer_.reset();
  }

  /// Writes stability.json. One rank renders all frames again, because an earlier run may have written most of them.
  void measure_stability() {
    Renderer renderer(device_, moving_.scene(), resolved_, compilation_);
    Stability stability(renderer.session, renderer.frame, options_.traced);
    for_all_frames("stability", "stability.json is not written", [&](int i) {
      moving_.pose(options_.time_of(i));
      renderer.frame.scene_moved();
      renderer.frame.render(camera());
      stability.add(i, options_.time_of(i), moving_.scene(), camera());
    });
    nlohmann::json all = header_json();
    all["traced_spp"] = options_.traced;
    write_file(fs::path(options_.output) / "stability.json",
               stability_json(all, stability.steps()).dump(1) + "\n");
  }

  /// Writes the video from the files of all frames, on one rank.
  void write_video(Video& video) {
    for_all_frames("video", "the video is not written", [&](int i) {
      const Image image = read_image(options_.file(i));
      video.add(image.encoding == Encoding::srgb ? image : displayed(image));
    });
    video.finish();
  }

 private:
  struct Renderer {
    Session session;
    Frame frame;
    Renderer(const Device& device, const Scene& scene, const RenderOptions& options, Compilation compilation)
        : session(device, ProgramCache::of_user(), std::move(compilation)), frame(session, scene, options) {}
  };

  /// `lost`: the data missing after an interrupted run.
  template <typename Action>
  void for_all_frames(const char* title, const char* lost, const Action& action) {
    Progress progress(title, static_cast<std::uint64_t>(options_.frames));
    for (int i = 0; i < options_.frames; ++i, progress.advance()) {
      stop_if_interrupted(fmt::format("the frames are in {}, {}", options_.output, lost));
      action(i);
    }
  }

  Image displayed(const Image& image) const {
    return display_image(image, options_.request.exposure_of(moving_.scene()), options_.request.tonemap);
  }

  const SceneCamera& camera() const { return moving_.scene().camera(options_.request.camera); }
  fs::path times_file() const { return fs::path(options_.output) / "times.json"; }

  nlohmann::json described(double seconds) const {
    nlohmann::json all = describe(options_.request, resolved_, moving_.scene(), camera(), seconds);
    all["view"] = name_of(options_.view);
    return all;
  }

  /// Cache key over all inputs of a frame's pixels: program, device, options, scene content and its current pose.
  std::string key(const nlohmann::json& described) const {
    const Scene& posed = moving_.scene();
    Fingerprint print;
    print.add(still_).add(described.dump());
    print.add(std::vector{camera_view(camera(), resolved_.width, resolved_.height)});
    add_moving(print, posed);
    for (const SceneLight& light : posed.lights_for(camera())) print.add(std::vector{light.data});
    return print.hex();
  }

  /// Returns true if the frame was missing.
  bool render(int number) {
    const double seconds = options_.time_of(number);
    Clock::time_point started = Clock::now();
    moving_.pose(seconds);
    double pose_ms = milliseconds_since(started);
    const nlohmann::json description = described(seconds);
    const std::string key = this->key(description);
    if (holds_frame(options_.file(number), key)) return false;
    const bool first = !renderer_;
    if (first) renderer_.emplace(device_, moving_.scene(), resolved_, compilation_);
    auto& [session, frame] = *renderer_;
    started = Clock::now();
    if (moving_.moves()) frame.scene_moved();
    pose_ms += milliseconds_since(started);
    started = Clock::now();
    frame.render(camera());
    session.queue().finish();
    const double frame_ms = milliseconds_since(started);
    nlohmann::json stages = to_json(session.timeline().times());
    if (first) warn_of_unreached(session, frame, camera().name);
    started = Clock::now();
    write(number, frame, description, key);
    times_[number] = {{"frame", number},
                      {"time", seconds},
                      {"first", first},
                      {"pose_ms", pose_ms},
                      {"frame_ms", frame_ms},
                      {"write_ms", milliseconds_since(started)},
                      {"stages", std::move(stages)}};
    spdlog::debug("frame {}: {:.3f} s, {:.1f} ms", number, seconds, frame_ms);
    if (Clock::now() - times_written_ > kTimesEvery) write_times();
    return true;
  }

  void write(int number, Frame& frame, const nlohmann::json& description, const std::string& key) {
    Image image = view_image(frame, options_.view);
    if (tev_) tev_->show(tev_name(moving_.scene(), camera(), options_.view), image);
    image.metadata = metadata_of(description);
    image.metadata[kKey] = key;
    if (options_.format == FrameFormat::exr) return write_exr(options_.file(number), image);
    write_png(options_.file(number), displayed(image));
  }

  nlohmann::json header_json() const {
    nlohmann::json options = described(options_.from);
    options.erase("time");
    return {{"device", to_json(device_)},
            {"options", options},
            {"fps", options_.frames_per_second},
            {"from", options_.from}};
  }

  void write_times() {
    if (!ranks_.is_root()) return;
    write_file(times_file(), times_json(header_json(), times_).dump(1) + "\n");
    times_written_ = Clock::now();
  }

  const Options& options_;
  Ranks& ranks_;
  MovingScene moving_;
  RenderOptions resolved_;
  Device device_;
  std::string still_;    ///< key of all static content
  SequenceTimes times_;  ///< of this rank's frames; at rank 0 also those of an earlier run
  Clock::time_point times_written_ = Clock::now();
  Compilation compilation_;
  std::optional<Renderer> renderer_;  ///< empty before the first frame
  std::optional<Tev> tev_;
};

/// Checks the options before the scene is read.
void check_outputs(const Options& options) {
  if (const double last = options.time_of(options.frames - 1); last > bounds::kSeconds) {
    throw Error(ExitCode::usage, "--frames {}: the last is at {} s; allowed: up to {} s", options.frames,
                last, bounds::kSeconds);
  }
  if (!options.video.empty()) require_extension("--video", options.video, {".mp4"});
  if (options.traced > 0 && !options.stability)
    throw Error(ExitCode::usage, "--traced {}: needs --stability", options.traced);
  std::error_code failed;
  const fs::path folder = options.output;
  if (fs::exists(folder, failed) && !fs::is_directory(folder, failed))
    throw Error(ExitCode::run_time, "--output {}: exists and is not a folder", options.output);
  create_folder("--output", folder);
  check_writable(options.file(0));
  check_writable(folder / "times.json");
  if (options.stability) check_writable(folder / "stability.json");
}

/// Warns if the folder holds frames of a longer run beyond this one's.
void warn_of_later_frames(const Options& options) {
  int last = options.frames;
  while (fs::exists(options.file(last))) ++last;
  if (last > options.frames)
    spdlog::warn("{} also holds frames {} to {} of a longer run", options.output, options.frames, last - 1);
}

void run(const Options& options, Shared& shared) {
  Ranks& ranks = shared.ranks();
  check_outputs(options);
  std::optional<Video> video;
  if (!options.video.empty() && ranks.is_root()) video.emplace(options.video, options.frames_per_second);
  Sequence sequence(options, shared, ranks);
  sequence.render();
  if (!ranks.is_root()) return;
  warn_of_later_frames(options);
  if (options.stability) sequence.measure_stability();
  if (video) sequence.write_video(*video);
}

}  // namespace sequence_command

void add_sequence(CLI::App& app, Shared& shared) {
  using namespace sequence_command;
  CLI::App* command = app.add_subcommand("sequence", "Render an animated scene frame by frame");
  auto options = std::make_shared<sequence_command::Options>();
  add(*command, "-o,--output", "DIR", options->output,
      "output folder for frame-0000.exr, ... and times.json; created if missing")
      ->required();
  add(*command, "--frames", "N", options->frames, "number of frames")
      ->check(CLI::Range(1, kMaxFrames))
      ->required();
  add_number(*command, "--fps", options->frames_per_second,
             "frame rate [frames per second of the scene's time]",
             {std::numeric_limits<double>::min(), kMaxFramesPerSecond,
              fmt::format("more than 0, up to {}", kMaxFramesPerSecond)})
      ->required()
      ->type_name("RATE");
  add_seconds(*command, "--from", options->from, "time of the first frame [s]");
  add_choice(*command, "--view", options->view, "view of the frames");
  add_choice(*command, "--format", options->format,
             "file format of the frames: linear EXR, or tone-mapped sRGB PNG");
  add(*command, "--video", "FILE.mp4", options->video, "output video of all frames; needs ffmpeg");
  command->add_flag("--stability", options->stability,
                    "write stability.json: change of light between frames on static surfaces");
  add(*command, "--traced", "SPP", options->traced,
      "paths per pixel for the path-traced noise of --stability")
      ->check(CLI::Range(1u, reference::PathTracerOptions::kMaxSamples));
  add_tev(*command, options->tev);
  add_shown_options(*command, options->request);
  add_render_request(*command, options->request);
  command->footer(
      "Frame i shows FROM + i / RATE seconds, identical to `clpv render --time` of that time.\n"
      "An interrupted run resumes: frames whose file has the same inputs are not rendered again.\n"
      "times.json has the times of all frames, and median, 95th percentile and maximum of each stage [ms].\n"
      "mpirun -n N clpv sequence ... distributes the frames over N ranks (docs/scale.md).");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
