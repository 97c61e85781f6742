// SPDX-License-Identifier: MIT
// Holds each stage's kernels against its double-precision CPU reference, on any device: what `clpv check` and the
// tests run.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "basis/basis.hpp"
#include "device/session.hpp"
#include "options/stages.hpp"
#include "volume/volume_format.hpp"

namespace clpv::reference {

/// The outcome of one comparison.
struct CheckResult {
  std::string stage;    ///< "propagate"
  std::string variant;  ///< what varied: "sh2/sampled/blockers"
  double worst = 0;     ///< largest error, as the tolerance table defines it for the stage
  double allowed = 0;   ///< tolerance(stage)
  std::string
      place;  ///< where the worst error is, with both values: "cell 3,4,5 channel 0: 0.25, CPU reference 0.26"
  bool passed() const { return worst <= allowed; }  // false for NaN too
  /// Takes an error that is the worst so far, and from `where` its place. A NaN is worse than any number, and stays.
  template <typename Where>
  void take(double error, const Where& where) {
    if (std::isnan(worst) || error <= worst) return;
    worst = error;
    place = where();
  }
};

using CheckResults = std::vector<CheckResult>;

/// Those of `formats`, beside the default soa/float, in which the device can hold volumes of this shape.
std::vector<VolumeFormat> other_formats(const Device& device, const VolumeShape& shape,
                                        const std::vector<VolumeFormat>& formats);

/// What a check goes through; parts of it where tests want each to be short.
struct CheckScope {
  bool thorough = false;  ///< every combination of basis and options: minutes, for kernels to build
  std::vector<std::string> bases = basis_names();
  std::vector<VolumeFormat> formats = all_formats();  ///< those that the device lacks are left out
};

/// A stage's. Small inputs: each ends within seconds on a CPU device, but for building kernels.
CheckResults check(Stage stage, Session& session, const CheckScope& scope = {});

// One for each stage, in host/verify/.
using StageCheck = CheckResults(Session& session, const CheckScope& scope);
StageCheck check_sizes, check_rasterize, check_emit, check_inject, check_blockers, check_reflectors,
    check_propagate, check_sweep, check_bounce, check_visibility, check_gather, check_shade;

}  // namespace clpv::reference
