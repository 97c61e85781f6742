// SPDX-License-Identifier: MIT
// Compares each stage's kernels with its double-precision CPU reference, on any device; `clpv check` and tests run it.
#pragma once

#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <type_traits>
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
  double seconds = 0;                               ///< time of the comparison, with building its kernels
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

/// Returns the formats, without the default soa/float, in which the device can store volumes of this shape.
std::vector<VolumeFormat> other_formats(const Device& device, const VolumeShape& shape,
                                        const std::vector<VolumeFormat>& formats);

/// Scope of a check. The default covers each path of a kernel once: one basis of each kind of code (harmonics, radial
/// functions with and without opposite centres, bins), each volume layout and each number format. It omits
/// variants that differ only in constants (exact face fluxes of all bases, further directions and grid sizes) and
/// combinations of basis, format and option; `thorough` has them. Building kernels is nearly all of the time.
struct CheckScope {
  bool thorough = false;  ///< every combination of basis and options
  std::vector<std::string> bases = {"sh2", "sh3", "srbf4", "srbf8v2", "bins24"};
  /// Formats beside the default; those that the device does not support are skipped.
  std::vector<VolumeFormat> formats = {{Layout::soa, Storage::float16},
                                       {Layout::aos, Storage::float32},
                                       {Layout::tiled, Storage::float16},
                                       {Layout::image, Storage::float16}};
  /// Called once per comparison, in a fixed order; returns true if it shall run. Null: all run.
  std::function<bool(std::string_view stage, const std::string& variant)> selects = {};
  /// Called with the results of each comparison as soon as it is done; may be null.
  std::function<void(const CheckResults&)> finished = {};
};

/// Every combination of bases, formats and options.
CheckScope thorough_scope();

/// Runs the comparison `compare` of this name if the scope selects it, and appends its result or results.
template <typename Compare>
void compare_selected(const CheckScope& scope, std::string_view stage, const std::string& variant,
                      CheckResults& results, const Compare& compare) {
  if (scope.selects && !scope.selects(stage, variant)) return;
  const auto start = std::chrono::steady_clock::now();
  CheckResults found;
  if constexpr (std::is_same_v<std::invoke_result_t<Compare>, CheckResult>) {
    found.push_back(compare());
    found.back().variant = variant;
  } else {
    found = compare();
  }
  found.back().seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (scope.finished) scope.finished(found);
  results.insert(results.end(), found.begin(), found.end());
}

/// Check of one stage. Inputs are small: apart from building kernels, each check takes seconds on a CPU device.
CheckResults check(Stage stage, Session& session, const CheckScope& scope = {});

// One function per stage, in host/verify/.
using StageCheck = CheckResults(Session& session, const CheckScope& scope);
StageCheck check_sizes, check_rasterize, check_emit, check_inject, check_blockers, check_reflectors,
    check_propagate, check_sweep, check_bounce, check_visibility, check_gather, check_near, check_medium,
    check_shade;

}  // namespace clpv::reference
