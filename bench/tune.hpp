// SPDX-License-Identifier: MIT
// Finds the launch shapes and the layout that propagate fastest on a device.
#pragma once

#include <vector>

#include "bench/suites.hpp"
#include "options/render_options.hpp"
#include "pipeline/tuning.hpp"

namespace clpv::bench {

struct TuneOptions {
  SuiteOptions suite = rendering();  ///< bases: those to tune; settings: what is propagated
  std::vector<Layout> layouts;       ///< to choose from; empty: all
  int repetitions = 7;

  /// What frames of the published scheme propagate, in a frame's storage: a sweep takes no steps to tune.
  static SuiteOptions rendering();
};

/// One subject's outcome: the shape that is used without tuning, and the best.
struct Tuned {
  TuningSubject subject;
  Tuning best;
  double usual_ms = 0, best_ms = 0;
};

/// For each basis: every layout with every candidate shape, then the layout that is fastest (subject.layout empty, its
/// usual_ms that of `soa`). The usual shape stays where none is faster by kLeastGain. Shapes whose output was wrong, or
/// that the device refuses, do not count. Reports come as work goes on, on the log.
std::vector<Tuned> tune(Session& session, const TuneOptions& options);
inline constexpr double kLeastGain = 0.03;

}  // namespace clpv::bench
