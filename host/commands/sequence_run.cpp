// SPDX-License-Identifier: MIT
#include "commands/sequence_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "commands/choices.hpp"
#include "commands/sequence_stability.hpp"
#include "image/image_io.hpp"
#include "parallel/rank_device.hpp"
#include "parallel/schedule.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

// A run that is killed loses the times of this many seconds at most, and none of its frames.
constexpr std::chrono::seconds kTimesEvery{10};

double milliseconds(std::chrono::steady_clock::duration span) {
  return std::chrono::duration<double, std::milli>(span).count();
}

constexpr const char* kTimesOfRank = "times.rank-";  // and its number: until rank 0 has all

/// Files of times that ranks of a run left which did not come to its end.
std::vector<fs::path> times_of_ranks(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().starts_with(kTimesOfRank)) files.push_back(entry.path());
  }
  return files;
}

}  // namespace

Sequence::Sequence(const SequenceOptions& options, const Shared& shared, Team& team)
    : options_(options),
      team_(team),
      moving_(options.request.scene, {options.request.model}),
      resolved_(resolve_options(options.request.frame, moving_.scene())),
      device_(device_of_rank(team, shared.device)),
      identity_(moving_.scene(), device_, resolved_) {
  tell_of_scene(moving_.scene(), moving_.scene().camera(options.request.camera), resolved_);
  if (!moving_.moves()) spdlog::warn("{}: nothing moves in it: all frames are alike", options.request.scene);
}

nlohmann::json Sequence::described(int frame) const {
  nlohmann::json all =
      describe(options_.request, resolved_, moving_.scene(), camera(), options_.instant(frame));
  all["view"] = name_of(options_.view);
  return all;
}

/// Whether a frame's file is there, and of the same.
bool Sequence::there(int frame) {
  if (!fs::exists(file_of(frame))) return false;
  moving_.pose(options_.instant(frame));
  return holds_frame(file_of(frame), identity_.of(moving_.scene(), camera(), described(frame)));
}

/// Frames whose files are not there, or are of something else: each rank looks at some. The times of the others are kept.
std::vector<std::size_t> Sequence::missing() {
  std::vector<int> found, all;
  team_.agree([&] {
    for (int i = team_.rank(); i < options_.frames; i += team_.size()) {
      if (there(i)) found.push_back(i);
    }
  });
  const std::vector<std::string> told = team_.gather(nlohmann::json(found).dump());
  const std::string told_all = team_.from_first([&] {
    for (const std::string& one : told) {
      const auto some = nlohmann::json::parse(one).get<std::vector<int>>();
      all.insert(all.end(), some.begin(), some.end());
    }
    std::ranges::sort(all);
    keep_times(all);
    return nlohmann::json(all).dump();
  });
  all = nlohmann::json::parse(told_all).get<std::vector<int>>();
  if (!all.empty()) spdlog::info("{} of {} frames are there already", all.size(), options_.frames);
  std::vector<std::size_t> missing;
  for (int i = 0; i < options_.frames; ++i) {
    if (!std::ranges::binary_search(all, i)) missing.push_back(static_cast<std::size_t>(i));
  }
  return missing;
}

/// Of a run before, which may have ended with files of several ranks.
void Sequence::keep_times(const std::vector<int>& there) {
  times_.keep(fs::path(options_.output) / "times.json", there);
  for (const fs::path& file : times_of_ranks(options_.output)) times_.keep(file, there);
}

FrameTimes Sequence::render(Session& session, Frame& frame, int number) {
  FrameTimes times;
  const Clock::time_point started = Clock::now();
  moving_.pose(options_.instant(number));
  if (moving_.moves()) frame.scene_moved();
  const Clock::time_point posed = Clock::now();
  frame.render(camera());
  session.queue().finish();
  const Clock::time_point rendered = Clock::now();
  times.stages = session.timeline().times();
  write_frame(file_of(number), options_.format, view_image(frame, options_.view), described(number),
              identity_.of(moving_.scene(), camera(), described(number)));
  times.pose_ms = milliseconds(posed - started);
  times.frame_ms = milliseconds(rendered - posed);
  times.write_ms = milliseconds(Clock::now() - rendered);
  return times;
}

nlohmann::json Sequence::about() const {
  nlohmann::json options = describe(options_.request, resolved_, moving_.scene(), camera(), options_.from);
  options.erase("time");
  options["view"] = name_of(options_.view);
  return {{"device", {{"platform", device_.platform}, {"name", device_.name}, {"driver", device_.driver}}},
          {"options", options},
          {"fps", options_.frames_per_second},
          {"from", options_.from}};
}

/// Each rank writes its own, and rank 0 what there is besides.
fs::path Sequence::times_file() const {
  return fs::path(options_.output) /
         (team_.leads() ? "times.json" : fmt::format("{}{}.json", kTimesOfRank, team_.rank()));
}

void Sequence::write_times() {
  write_file(times_file(), times_.to_json(about()).dump(1) + "\n");
  times_written_ = Clock::now();
}

/// All of them into one file, and those of ranks away.
void Sequence::gather_times() {
  const std::vector<std::string> told = team_.gather(times_.to_json(about()).dump());
  if (!team_.leads()) return;
  for (const std::string& one : told) times_.merge(nlohmann::json::parse(one));
  write_times();
  for (const fs::path& file : times_of_ranks(options_.output)) fs::remove(file);
}

void Sequence::render_one(int number) {
  at_ = number;
  const bool first = !renderer_;
  if (first) renderer_.emplace(device_, moving_.scene(), resolved_);
  FrameTimes times = render(renderer_->session, renderer_->frame, number);
  times.first = first;
  times_.add(number, options_.instant(number), times);
  spdlog::debug("frame {}: {:.3f} s, {:.1f} ms", number, options_.instant(number), times.frame_ms);
  if (Clock::now() - times_written_ > kTimesEvery) write_times();
}

void Sequence::render_missing(const std::vector<std::size_t>& missing) {
  const std::vector<Piece> runs = shrinking_runs(missing, team_.size());
  const std::size_t there = static_cast<std::size_t>(options_.frames) - missing.size();
  Progress progress("sequence", missing.size());
  const auto kept = [&] {
    write_times();
    return fmt::format("{} of {} frames are in {}; the same command goes on", there + team_.done(0),
                       options_.frames, options_.output);
  };
  const auto render_run = [&](std::size_t run) {
    for (const std::size_t number : runs[run]) {
      if (interrupted()) throw Interrupted(kept());
      render_one(static_cast<int>(number));
      team_.done(1);
    }
  };
  try {
    team_.share({runs.size(), render_run, [&] { return fmt::format("frame {}", at_); }, &progress, kept});
  } catch (const TeamFailure&) {
    write_times();
    throw;
  }
}

void Sequence::run() {
  const std::vector<std::size_t> missing = this->missing();
  const Clock::time_point started = Clock::now();
  if (!missing.empty()) render_missing(missing);
  gather_times();
  if (missing.empty()) return;
  spdlog::info("{} frames in {:.1f} s", missing.size(), milliseconds(Clock::now() - started) / 1000);
  if (renderer_ && team_.local_rank() == 0) renderer_->session.store_programs();
  renderer_.reset();
}

void Sequence::measure_stability() {
  Progress progress("stability", static_cast<std::uint64_t>(options_.frames));
  Session session(device_, ProgramCache::of_user());
  Frame frame(session, moving_.scene(), resolved_);
  SequenceStability stability(session, frame, options_.traced);
  for (int i = 0; i < options_.frames; ++i) {
    stop_if_interrupted(fmt::format("the frames are in {}, their stability is not told", options_.output));
    moving_.pose(options_.instant(i));
    frame.scene_moved();
    frame.render(camera());
    stability.add(i, options_.instant(i), moving_.scene(), camera());
    progress.advance();
  }
  write_file(fs::path(options_.output) / "stability.json", stability.to_json(about()).dump(1) + "\n");
}

void Sequence::film(Video& video) {
  Progress progress("film", static_cast<std::uint64_t>(options_.frames));
  const auto curve = named<ToneMap>("--tonemap", options_.request.tonemap);
  for (int i = 0; i < options_.frames; ++i) {
    stop_if_interrupted(fmt::format("the frames are in {}, the film is not made", options_.output));
    const Image image = read_image(file_of(i));
    video.add(image.encoding == Encoding::srgb
                  ? image
                  : display_image(image, options_.request.exposure_of(moving_.scene()), curve));
    progress.advance();
  }
  video.finish();
}

}  // namespace clpv
