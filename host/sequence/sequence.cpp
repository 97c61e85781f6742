// SPDX-License-Identifier: MIT
#include "sequence/sequence.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "device/result_keys.hpp"
#include "image/image_io.hpp"
#include "pipeline/raster/view.hpp"
#include "sequence/stability.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/interrupt.hpp"
#include "support/json_optional.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"
#include "times/time_record.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr int kSchema = 1;

}  // namespace

void TimesSummary::add(const FrameLine& line) {
  ++frames_;
  if (line.first) return;
  pose_.push_back(line.pose_ms);
  frame_.push_back(line.frame_ms);
  write_.push_back(line.write_ms);
  if (line.stages.empty()) return;  // by a clock at fault
  (line.stages.front().from_events ? by_events_ : by_host_).add(line.stages);
}

json TimesSummary::to_json() const {
  json all = {{"frames", frames_}, {"steady", frame_.size()}, {"times", json::array()}};
  if (frame_.empty()) return all;
  std::vector<TimeRecord> times = {time_record("pose", pose_), time_record("frame", frame_),
                                   time_record("write", write_)};
  const FrameTimes& stages = by_host_.count() > 0 ? by_host_ : by_events_;
  std::ranges::move(stages.stage_records(), std::back_inserter(times));
  all["times"] = times;
  all["timer"] = stages.from_events() ? "event" : "wall";
  return all;
}

json stability_json(const json& about, std::span<const StabilityStep> steps) {
  json all = about, frames = json::array();
  std::vector<double> inside, across;
  for (const StabilityStep& step : steps) {
    frames.push_back({{"frame", step.frame},
                      {"time", step.seconds},
                      {"still", step.still},
                      {"cascades_moved", step.cascades_moved},
                      {"seen", step.seen},
                      {"change", step.change.mean},
                      {"change_p95", step.change.p95},
                      {"traced", step.noise}});
    if (step.still && step.change.mean)
      (step.cascades_moved.empty() ? inside : across).push_back(*step.change.mean);
  }
  all.update({{"schema", kSchema}, {"frames", std::move(frames)}});
  for (const auto& [name, samples] :
       {std::pair("inside_cells", inside), std::pair("across_cells", across)}) {
    if (samples.empty()) {
      all["summary"][name] = nullptr;
      all["note"] =
          "null: no two successive frames of an unchanged scene show light under that condition";
      continue;
    }
    const Statistics figures = statistics_of(samples);
    all["summary"][name] = {{"frames", samples.size()},
                            {"median", figures.median},
                            {"p95", figures.p95},
                            {"worst", figures.max}};
  }
  return all;
}

namespace {

namespace fs = std::filesystem;

constexpr const char* kKey = "frame_key";       // metadata: the key of a frame
constexpr const char* kPixels = "pixels_hash";  // metadata: hash of the pixels
constexpr std::size_t kKeyDigits = 16;

std::string pixels_hash(const Image& image) {
  Fingerprint print;
  add_pixels(print, image);
  return print.hex();
}

bool has(const std::map<std::string, std::string>& metadata, const char* name,
         const std::string& value) {
  const auto found = metadata.find(name);
  return found != metadata.end() && found->second == value;
}

/// Returns true if the file holds a frame with that key, and its pixels as clpv wrote them. Warns
/// about damaged files.
bool holds_frame(const fs::path& file, const std::string& key) {
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return false;
  try {
    if (!has(read_metadata(file), kKey, key)) return false;
    const Image image = read_image(file);
    if (has(image.metadata, kPixels, pixels_hash(image))) return true;
    log_warning("{}: its pixels were changed; it is rendered again", file.string());
    return false;
  } catch (const Error& error) {
    log_warning("{}; it is rendered again", error.what());
    return false;
  }
}

}  // namespace

bool is_frame(const fs::path& file) {
  try {
    return read_metadata(file).contains(kKey);
  } catch (const Error&) {
    return false;
  }
}

fs::path SequenceOptions::file(int frame) const {
  return fs::path(folder) / fmt::format("frame-{:04}.{}", frame, name_of(format));
}

Sequence::Sequence(const SequenceOptions& options, SequenceSubject subject, MovingScene& scene,
                   const FrameSetup& setup, const Device& device, Compilation compilation,
                   Ranks& ranks)
    : options_(options),
      subject_(std::move(subject)),
      moving_(scene),
      setup_(setup),
      device_(device),
      compilation_(std::move(compilation)),
      ranks_(ranks),
      times_(fs::path(options.folder) / "times.jsonl") {
  Fingerprint still, settings;
  still.add(pixels_key(device_, setup_.options)).add(scene_fingerprint(moving_.scene()));
  still_ = still.hex();
  settings.add(still_).add(times_key(device_, setup_.options, ranks.processors()));
  settings_ = settings.add(header_json().dump()).hex();
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
      const bool fresh = render(i);  // a signal may also end it where it compiles kernels
      (fresh ? rendered : there) += 1;
      fresh ? progress.advance() : progress.skip();
    } catch (const Interrupted&) {
      throw Interrupted(fmt::format("stopped at frame {} of {}; the same command resumes in {}", i,
                                    options_.frames, options_.folder));
    }
  }
  ranks_.sum(counts);
  if (there > 0) log_info("{} of {} frames existed already", there, options_.frames);
  if (rendered > 0) log_info("{} frames in {:.1f} s", rendered, ms_since(started) / 1000);
  write_summary();
  if (renderer_) renderer_->session.programs().store();
  renderer_.reset();
}

template <typename Action>
void Sequence::for_all_frames(const char* title, const Action& action) {
  Progress progress(title, static_cast<std::uint64_t>(options_.frames));
  for (int i = 0; i < options_.frames; ++i, progress.advance()) {
    stop_if_interrupted();
    action(i);
  }
}

void Sequence::measure_stability() {
  Renderer renderer(device_, moving_.scene(), setup_, compilation_);
  Stability stability(renderer.session, renderer.frame, options_.traced);
  for_all_frames("stability", [&](int i) {
    moving_.pose(options_.time_of(i));
    renderer.frame.scene_moved();
    renderer.frame.render(camera());
    stability.add(i, options_.time_of(i), moving_.scene(), camera());
  });
  nlohmann::json all = header_json();
  all["traced_spp"] = options_.traced;
  write_file(fs::path(options_.folder) / "stability.json",
             stability_json(all, stability.steps()).dump(1) + "\n", OutputFile::Kind::derived);
}

void Sequence::for_all_images(const std::function<void(const Image&)>& action) {
  for_all_frames("video", [&](int i) {
    const Image image = read_image(options_.file(i));
    action(image.encoding == Encoding::srgb ? image : subject_.displayed(image));
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
  print.add(std::vector{camera_view(camera(), setup_.options.width, setup_.options.height)});
  add_moving(print, posed);
  for (const SceneLight& light : posed.lights_for(camera())) print.add(std::vector{light.data});
  return print.hex();
}

/// Returns true if the frame was missing.
bool Sequence::render(int number) {
  const double seconds = options_.time_of(number);
  Clock::time_point started = Clock::now();
  moving_.pose(seconds);
  const double host_ms = ms_since(started);
  const nlohmann::json description = described(seconds);
  FrameLine line;
  line.frame = number, line.seconds = seconds;
  line.key = key(description), line.settings = settings_;
  keys_ += line.key;
  if (holds_frame(options_.file(number), line.key)) return false;
  line.first = !renderer_;
  if (line.first) renderer_.emplace(device_, moving_.scene(), setup_, compilation_);
  auto& [session, frame] = *renderer_;
  started = Clock::now();
  if (moving_.moves()) frame.scene_moved();
  line.pose_ms = host_ms + ms_since(started);
  started = Clock::now();
  frame.render(camera());
  session.timeline().finish(session.queue());
  line.frame_ms = ms_since(started);
  if (!line.first) line.stages = session.timeline().times();
  if (line.first) subject_.first_frame(session, frame);
  log_debug("frame {}: {:.3f} s, {:.1f} ms", number, seconds, line.frame_ms);
  write(std::move(line), frame, description);
  return true;
}

/// Writes the frame and its times. The times come first, so that no frame lacks them.
void Sequence::write(FrameLine line, Frame& frame, const nlohmann::json& description) {
  const Clock::time_point started = Clock::now();
  const Image image = view_image(frame, options_.view);
  Image shown = options_.format == FrameFormat::exr ? image : subject_.displayed(image);
  shown.metadata = metadata_of(description);
  shown.metadata[kKey] = line.key;
  shown.metadata[kPixels] = pixels_hash(shown);
  const std::vector<unsigned char> bytes =
      options_.format == FrameFormat::exr ? exr_bytes(shown) : png_bytes(shown);
  OutputFile file(options_.file(line.frame), OutputFile::Kind::derived);
  file.write(std::as_bytes(std::span(bytes)));
  line.write_ms = ms_since(started);
  times_.append(to_json(line));
  file.commit();
}

nlohmann::json Sequence::header_json() const {
  nlohmann::json options = described(options_.from);
  options.erase("time");
  return {{"device", to_json(device_)},
          {"options", options},
          {"fps", options_.frames_per_second},
          {"from", options_.from}};
}

/// Collective: rank 0 appends the summary of all frames' times.
void Sequence::write_summary() {
  const std::vector<std::string> gathered = ranks_.gather(keys_);
  if (!ranks_.is_root()) return;
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < static_cast<std::size_t>(options_.frames); ++i)
    keys.push_back(
        gathered[i % gathered.size()].substr(i / gathered.size() * kKeyDigits, kKeyDigits));
  TimesSummary summary;
  times_.read(keys, settings_, [&](const FrameLine& line) { summary.add(line); });
  nlohmann::json all = header_json();
  all.update(summary.to_json());
  all["settings"] = settings_;
  times_.append({{"summary", std::move(all)}});
}

}  // namespace clpv
