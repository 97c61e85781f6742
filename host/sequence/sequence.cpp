// SPDX-License-Identifier: MIT
#include "sequence/sequence.hpp"

#include <fmt/format.h>

#include "device/kernel_files.hpp"
#include "image/image_io.hpp"
#include "pipeline/frame/frame_times.hpp"
#include "pipeline/raster/view.hpp"
#include "quality/ground_truth.hpp"
#include "sequence/stability.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKey = "frame_key";        // metadata: the key of a frame
constexpr std::chrono::seconds kTimesEvery{10};  // interval of saving times.json

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
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

}  // namespace

fs::path SequenceOptions::file(int frame) const {
  return fs::path(folder) / fmt::format("frame-{:04}.{}", frame, name_of(format));
}

Sequence::Sequence(const SequenceOptions& options, SequenceSubject subject, MovingScene& scene,
                   const RenderOptions& resolved, const Device& device, Compilation compilation,
                   Ranks& ranks)
    : options_(options),
      subject_(std::move(subject)),
      moving_(scene),
      resolved_(resolved),
      device_(device),
      compilation_(std::move(compilation)),
      ranks_(ranks) {
  Fingerprint print;
  print.add(program_fingerprint()).add(device_.platform).add(device_.name).add(device_.driver);
  still_ = print.add(scene_fingerprint(moving_.scene())).hex();
  if (ranks.is_root()) times_ = read_times(times_file(), options.frames);
}

void Sequence::render() {
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
      throw Interrupted(fmt::format("{} of {} frames are in {}; the same command resumes",
                                    rendered + there, mine, options_.folder));
    }
    progress.advance();
  }
  ranks_.sum(counts);
  if (there > 0) spdlog::info("{} of {} frames existed already", there, options_.frames);
  if (rendered > 0)
    spdlog::info("{} frames in {:.1f} s", rendered, milliseconds_since(started) / 1000);
  for (const std::string& gathered : ranks_.gather(nlohmann::json(times_).dump()))
    for (auto& [number, frame] : nlohmann::json::parse(gathered).get<SequenceTimes>())
      times_[number] = frame;
  write_times();
  if (renderer_) renderer_->session.store_programs();
  renderer_.reset();
}

/// `lost`: the data missing after an interrupted run.
template <typename Action>
void Sequence::for_all_frames(const char* title, const char* lost, const Action& action) {
  Progress progress(title, static_cast<std::uint64_t>(options_.frames));
  for (int i = 0; i < options_.frames; ++i, progress.advance()) {
    stop_if_interrupted(fmt::format("the frames are in {}, {}", options_.folder, lost));
    action(i);
  }
}

void Sequence::measure_stability() {
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
  write_file(fs::path(options_.folder) / "stability.json",
             stability_json(all, stability.steps()).dump(1) + "\n");
}

void Sequence::for_all_images(const std::function<void(const Image&)>& action) {
  for_all_frames("video", "the video is not written", [&](int i) {
    const Image image = read_image(options_.file(i));
    action(image.encoding == Encoding::srgb ? image : displayed(image));
  });
}

nlohmann::json Sequence::described(double seconds) const {
  nlohmann::json all = subject_.describe(moving_.scene(), seconds);
  all["view"] = name_of(options_.view);
  return all;
}

/// Returns the cache key over all inputs of a frame's pixels: program, device, options, scene
/// content and its current pose.
std::string Sequence::key(const nlohmann::json& described) const {
  const SceneData& posed = moving_.scene();
  Fingerprint print;
  print.add(still_).add(described.dump());
  print.add(std::vector{camera_view(camera(), resolved_.width, resolved_.height)});
  add_moving(print, posed);
  for (const SceneLight& light : posed.lights_for(camera())) print.add(std::vector{light.data});
  return print.hex();
}

/// Returns true if the frame was missing.
bool Sequence::render(int number) {
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
  if (first) subject_.first_frame(session, frame);
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

void Sequence::write(int number, Frame& frame, const nlohmann::json& description,
                     const std::string& key) {
  Image image = view_image(frame, options_.view);
  image.metadata = metadata_of(description);
  image.metadata[kKey] = key;
  if (options_.format == FrameFormat::exr) return write_exr(options_.file(number), image);
  write_png(options_.file(number), displayed(image));
}

nlohmann::json Sequence::header_json() const {
  nlohmann::json options = described(options_.from);
  options.erase("time");
  return {{"device", to_json(device_)},
          {"options", options},
          {"fps", options_.frames_per_second},
          {"from", options_.from}};
}

void Sequence::write_times() {
  if (!ranks_.is_root()) return;
  write_file(times_file(), times_json(header_json(), times_).dump(1) + "\n");
  times_written_ = Clock::now();
}

}  // namespace clpv
