// SPDX-License-Identifier: MIT
// A job: work of one stage on a device that can be repeated, and the comparison of its output with
// the CPU reference. `clpv check` runs jobs on small random inputs, `clpv bench` times them on a
// scene's.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "reference/volume.hpp"
#include "support/named_enum.hpp"

namespace clpv {

namespace verify {

enum class Status {
  ok,
  wrong,        ///< the output differs from the reference by more than the tolerance
  failed,       ///< the driver reported an error, crashed, or took too long
  unsupported,  ///< the device lacks a capability
};

}  // namespace verify

template <>
inline constexpr auto kNames<verify::Status> = name_list("ok", "wrong", "failed", "unsupported");

namespace verify {

/// Largest error of an output against its reference, as verify/tolerances.hpp defines it for the
/// stage.
struct Deviation {
  double worst = 0, allowed = 0;
  std::string place = {};  ///< place of the largest error, with both values; empty without an error

  bool passed() const { return worst <= allowed; }  // false for NaN
  /// Records an error if it is the largest so far, with its place from `where`. A NaN exceeds any
  /// number and stays.
  template <typename Where>
  void take(double error, const Where& where) {
    if (std::isnan(worst) || error <= worst) return;
    worst = error;
    place = where();
  }
};

struct Job {
  std::function<void()> reset = {};  ///< clears outputs before a repetition; may be null
  std::function<void()> run = {};    ///< enqueues the work
  std::function<Deviation()> compare =
      {};  ///< checks the last repetition's output; null: no reference
};

inline constexpr double kChannels = 3;  ///< red, green, blue

using SharedVolume = std::shared_ptr<const reference::Volume>;

/// Result of a CPU reference, in Volume's host order.
using Values = std::shared_ptr<const std::vector<double>>;
/// Returns the values that `compute` gives. Jobs with the same expected result share one
/// computation.
using Share = std::function<Values(const std::function<std::vector<double>()>& compute)>;

/// Computes the values.
inline Values not_shared(const std::function<std::vector<double>()>& compute) {
  return std::make_shared<const std::vector<double>>(compute());
}

}  // namespace verify
}  // namespace clpv
