// SPDX-License-Identifier: MIT
// Stage `bounce`: reflects swept light off the surfaces of a cascade (kernels/sweep/bounce.cl;
// docs/method.md, 'More bounces').
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "options/stage_options.hpp"
#include "pipeline/sweep/sweep_volumes.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Reflects swept light off the surfaces of cascades. `swept` has a volume of planes for each
/// channel and bin; `injected` and `bounced` are light volumes of the basis. Deterministic to the
/// bit.
class Bouncer {
 public:
  /// `series`: the coarsest cascade evaluates the series of all bounces; finer ones interpolate
  /// incident flux.
  Bouncer(Session& session, const Basis& basis, const SweepOptions& options, bool series);

  /// Sets the reflectors of a cascade (reflector_masks), which must outlive this object. For the
  /// coarsest cascade it also restarts the series: S = R.
  void set_reflectors(std::size_t cascade, const Volume& reflectors);

  /// Writes S to `bounced`: in the coarsest cascade each face emits the light it reflects of 1 W.
  void inject_unit(Volume& bounced);
  /// Adds a term to the series, S = R (1 + E). `swept`: a sweep of the light of inject_unit().
  void extend_series(const Buffer& swept);

  /// Writes `share` I + R D. `swept` gives the incident flux D.
  void inject_reflected(std::size_t cascade, const Buffer& swept, float share,
                        const Volume& injected, Volume& bounced);
  /// Writes I + R D_1 + S D_2 in the coarsest cascade.
  void inject_series(const Buffer& first_swept, const Buffer& second_swept, const Volume& injected,
                     Volume& bounced);

  /// Incident flux on the faces of a cascade, written by sweep_collect.cl; null for the finest
  /// cascade and without a series.
  const Buffer* incident(std::size_t cascade) const {
    return cascade == 0 || incident_.empty() ? nullptr : &incident_[cascade - 1];
  }
  /// Writes I + R D. D is interpolated from incident() of the next coarser cascade. `offset`:
  /// offset_in_coarser().
  void inject_interpolated(std::size_t cascade, const std::array<int, 3>& offset,
                           const Volume& injected, Volume& bounced);

 private:
  SweepVolumes volumes_;
  std::vector<const Volume*> reflectors_;
  const Volume* series_ = nullptr;  ///< S so far: R of the coarsest cascade, or series_volume_
  std::unique_ptr<Volume> series_volume_;  ///< null without a series
  /// Flux on each face of all cascades except the finest; empty without a series.
  std::vector<Buffer> incident_;
  Kernel inject_reflected_;
  std::optional<Kernel> inject_unit_, extend_series_, inject_series_, inject_interpolated_;
};

}  // namespace clpv
