// SPDX-License-Identifier: MIT
// Statistics of a frame for `--stats`: device, options, stage times, memory and energies.
#pragma once

#include <array>
#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "times/frame_times.hpp"

namespace clpv {

/// Collects the statistics of one `clpv render`. Times are wall times unless the timer of a stage
/// is "event".
class FrameStats {
 public:
  void begin_startup() { mark_ = Clock::now(); }
  void end_startup();  ///< device opened, programs built, scene uploaded
  /// The first launches compile kernels for their work-group sizes.
  void end_first_frame(Session& session);
  /// Sets the times of the timed frames, of one camera. The statistics report their medians.
  void set_times(FrameTimes times) { times_ = std::move(times); }
  void add_energy(Session& session, const Frame& frame, const CascadeVolumes& volumes);

  /// Returns JSON of schema 2: device, options, times (`frame` on the host's clock, `host`: its
  /// work without waits, and the stages), kernels of one frame, timer of the stages, numbers of
  /// HostWork, first_launch_ms, build_ms, startup_ms, device_bytes, energy.
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
  FrameTimes times_;
  std::vector<Energy> energies_;
};

/// Returns the integral over directions summed over all cells of a light volume, per channel [W].
std::array<double, 3> volume_energy(Session& session, const Basis& basis, const Volume& volume);

}  // namespace clpv
