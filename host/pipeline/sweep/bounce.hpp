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

/// The light that a sweep injects (kernels/sweep/sources.h).
struct SweepSources {
  Buffer coefficients, lit;
};

/// Reflects swept light off the surfaces of cascades. `swept` has a volume of planes for each
/// channel and bin; `injected` is a light volume of the basis. Deterministic to the bit.
class Bouncer {
 public:
  /// `series`: evaluates the series of all bounces in every cascade. One bounce allows only
  /// inject_flux().
  Bouncer(Session& session, const Basis& basis, const SweepOptions& options, bool series);

  /// Writes light of which each face emits this flux [W]. `reflectors`: reflector_masks().
  void inject_flux(const Volume& flux, const Volume& reflectors, SweepSources& sources);
  /// Writes light of faces that emit radiance 1, of cells of 1 m^2.
  void inject_white(const Volume& reflectors, SweepSources& sources);

  /// Sets the reflectors R of a cascade: reflector_masks() over the incident flux of a white
  /// furnace, whose sweep is `swept`.
  const Volume& set_reflectors(std::size_t cascade, const Buffer& swept, const Volume& reflectors);
  /// Returns R X. `swept`: a sweep of inject_flux(R), whose incident flux is X.
  const Volume& reflect_returned(std::size_t cascade, const Buffer& swept);
  /// Sets the series S and E of a cascade. `swept`: a sweep of inject_flux() of reflect_returned().
  void sum_series(std::size_t cascade, const Buffer& swept);

  /// Writes I + R D, `relaxed` I + E D. `swept` gives the incident flux D.
  void inject_reflected(std::size_t cascade, const Buffer& swept, const Volume& injected,
                        SweepSources& sources, bool relaxed);
  /// Writes I + R D_1 + S (D_2 - D_1).
  void inject_series(std::size_t cascade, const Buffer& first_swept, const Buffer& second_swept,
                     const Volume& injected, SweepSources& sources);

 private:
  SweepVolumes volumes_;
  std::vector<Volume> reflectors_;    ///< R of each cascade; empty with one bounce
  std::vector<Volume> series_;        ///< S and E of each cascade; empty without a series
  std::unique_ptr<Volume> returned_;  ///< R X; null without a series
  Kernel inject_flux_;
  std::optional<Kernel> normalise_reflectors_, inject_reflected_;
  std::optional<Kernel> reflect_returned_, sum_series_, inject_series_;
};

}  // namespace clpv
