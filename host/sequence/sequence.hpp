// SPDX-License-Identifier: MIT
// Renders an animated scene frame by frame into a folder. An interrupted run resumes.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "image/image.hpp"
#include "image/tone_map.hpp"
#include "options/show.hpp"
#include "parallel/ranks.hpp"
#include "pipeline/frame/frame.hpp"
#include "scene/load.hpp"
#include "sequence/stability.hpp"
#include "sequence/times_file.hpp"
#include "support/named_enum.hpp"
#include "times/frame_times.hpp"

namespace clpv {

// Reports of `clpv sequence`: the summary in times.jsonl, and stability.json.

/// Sums up times of frames, one after another.
class TimesSummary {
 public:
  void add(const FrameLine& line);

  /// Number of frames, and of those without first frames (`steady`); `times`: records of pose,
  /// frame, write and the stages over steady frames; `timer` of the stages: wall where any frame's
  /// are the host's, whose stages alone count then, else event.
  nlohmann::json to_json() const;

 private:
  std::size_t frames_ = 0;
  std::vector<double> pose_, frame_, write_;  ///< [ms] of steady frames
  FrameTimes by_events_, by_host_;            ///< times of steady frames
};

/// Schema 1: the fields of `about`, the steps, and a summary of the steps with static lights and
/// triangles, grouped by whether a cascade moved.
nlohmann::json stability_json(const nlohmann::json& about, std::span<const StabilityStep> steps);

enum class FrameFormat : unsigned { exr, png };

template <>
inline constexpr auto kNames<FrameFormat> = name_list("exr", "png");

/// Frame i shows `from` + i / `frames_per_second` [s].
struct SequenceOptions {
  std::string folder;  ///< folder of frame-0000.exr, ... and times.jsonl
  int frames = 0;
  double frames_per_second = 0, from = 0;
  Show view = Show::full;
  FrameFormat format = FrameFormat::exr;
  /// Paths per pixel of the path-traced noise in stability.json; 0: none.
  std::uint32_t traced = 0;

  double time_of(int frame) const { return from + frame / frames_per_second; }
  std::filesystem::path file(int frame) const;
};

/// Content of the frames, and a function that receives the first.
struct SequenceSubject {
  std::string camera;
  std::function<Image(const Image& linear)> displayed;  ///< for PNG
  /// Inputs of a frame, by name.
  std::function<nlohmann::json(const SceneData& posed, double seconds)> describe;
  std::function<void(Session&, Frame&)> first_frame;  ///< called after the first frame
};

/// Returns true if the file has the metadata of a frame by clpv, of whatever scene.
bool is_frame(const std::filesystem::path& file);

/// Renders the frames; scene, device and device resources persist between frames. The ranks share
/// them out.
class Sequence {
 public:
  /// Throws as TimesFile.
  Sequence(const SequenceOptions& options, SequenceSubject subject, MovingScene& scene,
           const FrameSetup& setup, const Device& device, Compilation compilation, Ranks& ranks);

  /// Renders the missing frames of this rank, and appends the times of each to times.jsonl; then
  /// rank 0 appends a summary. Throws Interrupted, which names the frames that are kept.
  void render();

  /// Writes stability.json. One rank renders all frames again, because an earlier run may have
  /// written most of them.
  void measure_stability();

  /// Calls action(image) for the display image of each frame, from its file.
  void for_all_images(const std::function<void(const Image&)>& action);

 private:
  struct Renderer {
    Session session;
    Frame frame;
    Renderer(const Device& device, const SceneData& scene, const FrameSetup& setup,
             Compilation compilation)
        : session(device, ProgramCache::of_user(device), std::move(compilation)),
          frame(session, scene, setup) {}
  };
  using Clock = std::chrono::steady_clock;

  template <typename Action>
  void for_all_frames(const char* title, const Action& action);
  const SceneCamera& camera() const { return moving_.scene().camera(subject_.camera); }
  nlohmann::json described(double seconds) const;
  std::string key(const nlohmann::json& described) const;
  bool render(int number);
  void write(FrameLine line, Frame& frame, const nlohmann::json& description);
  nlohmann::json header_json() const;
  void write_summary();

  SequenceOptions options_;
  SequenceSubject subject_;
  MovingScene& moving_;
  FrameSetup setup_;
  Device device_;
  Compilation compilation_;
  Ranks& ranks_;
  TimesFile times_;
  std::string still_;                 ///< key of all static content
  std::string settings_;              ///< key of what this run's times share
  std::string keys_;                  ///< keys of this rank's frames, one after another
  std::optional<Renderer> renderer_;  ///< empty before the first frame
};

}  // namespace clpv
