// Holds each stage's kernels against its double-precision twin, on any device: what `clpv check` and the
// tests run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

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
};

using CheckResults = std::vector<CheckResult>;

/// Formats beside the default soa/float in which the device can hold volumes of this shape.
std::vector<VolumeFormat> other_formats(const Device& device, const VolumeShape& shape);
/// tolerance(stage), or that of half storage.
double tolerance_in(std::string_view stage, const VolumeFormat& format);

/// A stage's. `thorough`: every combination of basis and options, where there are more than it compares at once; minutes,
/// for the kernels there are to build.
CheckResults check(Stage stage, Session& session, bool thorough = false);

// One a stage, in reference/check_STAGE.cpp. Small inputs: each ends within seconds on a CPU device.
CheckResults check_sizes(Session& session);  ///< the shared structs' layout; worst in bytes
CheckResults check_rasterize(Session& session);
CheckResults check_inject(Session& session, bool thorough = false);
CheckResults check_block(Session& session);
CheckResults check_propagate(Session& session, bool thorough = false);
CheckResults check_sweep(Session& session, bool thorough = false);
CheckResults check_carry_late(Session& session);
CheckResults check_gather(Session& session, bool thorough = false);
CheckResults check_shade(Session& session);

}  // namespace clpv::reference
