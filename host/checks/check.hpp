// SPDX-License-Identifier: MIT
// Holds each stage's kernels against its double-precision twin, on any device: what `clpv check` and the
// tests run.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
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
  std::string place;  ///< where the worst error is, with both values: "cell 3,4,5 channel 0: 0.25, twin 0.26"
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
                                        const std::vector<VolumeFormat>& formats = all_formats());
/// tolerance(stage), or that of half storage.
double tolerance_in(std::string_view stage, const VolumeFormat& format);

/// What a check goes through; parts of it where tests want each to be short.
struct CheckScope {
  bool thorough = false;  ///< every combination of basis and options: minutes, for kernels to build
  std::vector<std::string> bases = basis_names();
  std::vector<VolumeFormat> formats = all_formats();  ///< those that the device lacks are left out
};

/// A stage's. The scope is for those of many variants: inject, propagate, sweep, bounce, gather.
CheckResults check(Stage stage, Session& session, const CheckScope& scope = {});

// One a stage, in checks/check_STAGE.cpp. Small inputs: each ends within seconds on a CPU device, but for building kernels.
CheckResults check_sizes(Session& session);  ///< the shared structs' layout; worst in bytes
CheckResults check_rasterize(Session& session);
CheckResults check_emit(Session& session);
CheckResults check_inject(Session& session, const CheckScope& scope = {});
CheckResults check_block(Session& session);
CheckResults check_reflect(Session& session);
CheckResults check_propagate(Session& session, const CheckScope& scope = {});
CheckResults check_sweep(Session& session, const CheckScope& scope = {});
CheckResults check_bounce(Session& session, const CheckScope& scope = {});
CheckResults check_see(Session& session);
CheckResults check_gather(Session& session, const CheckScope& scope = {});
CheckResults check_shade(Session& session);

}  // namespace clpv::reference
