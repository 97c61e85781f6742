// SPDX-License-Identifier: MIT
// A sequence at work: `clpv sequence` frame by frame, over the ranks of a team.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands/commands.hpp"
#include "commands/render_request.hpp"
#include "commands/sequence_frames.hpp"
#include "commands/sequence_times.hpp"
#include "commands/video.hpp"
#include "device/session.hpp"
#include "parallel/team.hpp"
#include "pipeline/frame.hpp"
#include "scene/load.hpp"

namespace clpv {

/// What is asked for. Frame i shows `from` + i / `frames_per_second` [s].
struct SequenceOptions {
  RenderRequest request;
  std::string output, video;
  int frames = 0;
  double frames_per_second = 0, from = 0;
  Show view = Show::full;
  FrameFormat format = FrameFormat::exr;
  bool stability = false;
  std::uint32_t traced = 0;

  double instant(int frame) const { return from + frame / frames_per_second; }
};

/// A sequence at work: the scene, the device and all that is made for it stay from frame to frame.
class Sequence {
 public:
  /// By all ranks of `team`. Throws Error for a scene or options that do not go together.
  Sequence(const SequenceOptions& options, const Shared& shared, Team& team);

  const Device& device() const { return device_; }
  /// Renders what is not there yet, and keeps the times; by all ranks. Throws Interrupted, saying what there is.
  void run();
  /// stability.json of all frames, rendered once more: most of them may be of an earlier run. By one rank.
  void measure_stability();
  /// All frames, from their files. By one rank.
  void film(Video& video);

 private:
  using Clock = std::chrono::steady_clock;
  /// What frames are rendered with.
  struct Renderer {
    Session session;
    Frame frame;
    Renderer(const Device& device, const Scene& scene, const RenderOptions& options)
        : session(device, ProgramCache::of_user()), frame(session, scene, options) {}
  };

  const Camera& camera() const { return moving_.scene().camera(options_.request.camera); }
  std::filesystem::path file_of(int frame) const {
    return frame_file(options_.output, frame, options_.format);
  }
  nlohmann::json described(int frame) const;
  bool there(int frame);
  std::vector<std::size_t> missing();
  void keep_times(const std::vector<int>& there);
  FrameTimes render(Session& session, Frame& frame, int number);
  void render_missing(const std::vector<std::size_t>& missing);
  void render_one(int number);
  nlohmann::json about() const;
  std::filesystem::path times_file() const;
  void write_times();
  void gather_times();

  const SequenceOptions& options_;
  Team& team_;
  MovingScene moving_;
  RenderOptions resolved_;
  Device device_;
  FrameIdentity identity_;
  SequenceTimes times_;  ///< of this rank; at rank 0 of frames that were there too
  Clock::time_point times_written_ = Clock::now();
  std::optional<Renderer> renderer_;  ///< none before its first frame
  int at_ = 0;                        ///< the frame it works on
};

}  // namespace clpv
