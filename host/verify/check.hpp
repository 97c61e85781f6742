// SPDX-License-Identifier: MIT
// Compares each stage's kernels with its double-precision CPU reference, on any device; `clpv check` and tests run it.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "basis/basis.hpp"
#include "device/session.hpp"
#include "options/stages.hpp"
#include "volume/volume_format.hpp"

namespace clpv::reference {

/// Result of one comparison.
struct CheckResult {
  std::string stage;    ///< "propagate"
  std::string variant;  ///< tested variant: "sh2/sampled/blockers"
  double worst = 0;     ///< largest error, as the tolerance table defines it for the stage
  double allowed = 0;   ///< tolerance(stage)
  std::string
      place;  ///< place of the largest error, with both values: "cell 3,4,5 channel 0: 0.25, CPU reference 0.26"
  bool passed() const { return worst <= allowed; }  // false for NaN too
  /// Records an error if it is the largest so far, with its place from `where`. A NaN exceeds any number and stays.
  template <typename Where>
  void take(double error, const Where& where) {
    if (std::isnan(worst) || error <= worst) return;
    worst = error;
    place = where();
  }
};

using CheckResults = std::vector<CheckResult>;

/// Returns those of `formats`, except the default soa/float, in which the device can store volumes of this shape.
std::vector<VolumeFormat> other_formats(const Device& device, const VolumeShape& shape,
                                        const std::vector<VolumeFormat>& formats);

/// Scope of a check; tests select parts of it to keep each test short.
struct CheckScope {
  bool thorough = false;  ///< every combination of basis and options; takes minutes to build kernels
  std::vector<std::string> bases = basis_names();
  std::vector<VolumeFormat> formats =
      all_formats();  ///< formats that the device does not support are skipped
};

/// Check of one stage. Inputs are small: apart from building kernels, each check takes seconds on a CPU device.
CheckResults check(Stage stage, Session& session, const CheckScope& scope = {});

// One function per stage, in host/verify/.
using StageCheck = CheckResults(Session& session, const CheckScope& scope);
StageCheck check_sizes, check_rasterize, check_emit, check_inject, check_blockers, check_reflectors,
    check_propagate, check_sweep, check_bounce, check_visibility, check_gather, check_near, check_shade;

}  // namespace clpv::reference
