// SPDX-License-Identifier: MIT
// What `--stats` tells of a frame: device, options, stage times, memory and energies.
#pragma once

#include <array>
#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "pipeline/frame.hpp"

namespace clpv {

/// Collects the figures of one `clpv render`; times are wall times unless a stage says "event".
class FrameStats {
 public:
  void begin_startup() { mark_ = Clock::now(); }
  void end_startup(const Session& session);  ///< device opened, programs built, scene uploaded
  void end_first_frame(Session& session);    ///< the first launches compile for their work-group sizes
  void begin_frame() { mark_ = Clock::now(); }
  /// Adds the timeline's stage times; frames of one camera have the same stages. Medians over all frames are told: the
  /// first one after a start still waits for memory and caches.
  void end_frame(Session& session);
  void add_energy(Session& session, const Frame& frame, const CascadeVolumes& volumes);

  /// Schema 1: device, options, frames (timed ones), stages, frame_ms, first_launch_ms, build_ms, startup_ms, device_bytes, energy.
  nlohmann::json to_json(const Session& session, const nlohmann::json& options) const;

 private:
  using Clock = std::chrono::steady_clock;
  double since_mark() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - mark_).count();
  }

  struct Energy {
    int cascade;
    std::array<double, 3> injected, accumulated;
  };
  Clock::time_point mark_;
  double startup_ms_ = 0, first_frame_ms_ = 0;
  std::vector<double> frame_ms_;                ///< one a timed frame
  std::vector<std::vector<StageTime>> stages_;  ///< the same
  std::vector<Energy> energies_;
};

/// Stage, cascade, light, milliseconds and timer of each.
nlohmann::json to_json(const std::vector<StageTime>& times);

/// Int f dw summed over all cells of a light volume, a channel [W].
std::array<double, 3> volume_energy(Session& session, const Basis& basis, const Volume& volume);

}  // namespace clpv
