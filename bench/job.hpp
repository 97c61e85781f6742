// SPDX-License-Identifier: MIT
// Jobs of a benchmark, and the cases that make them.
#pragma once

#include <functional>
#include <vector>

#include "bench/row.hpp"
#include "device/session.hpp"
#include "verify/job.hpp"

namespace clpv::bench {

using verify::Deviation, verify::kChannels;

/// A job of `clpv check`, with what only its timing needs.
struct Job : verify::Job {
  /// True: `run` marks stages on the timeline itself, and the row has wall times.
  bool own_stages = false;
  /// Called after each run, warm-up included; may be null.
  std::function<void(const std::vector<StageTime>&)> after_run = {};
  /// Adds numbers that only a run gives; called once, after all runs; may be null.
  std::function<void(Cost&)> count = {};
  /// Returns further rows, after the job's own; may be null.
  std::function<std::vector<Row>(const Row&)> more_rows = {};
};

/// A row before its measurement: its identity, and a function that sets up its work.
struct Case {
  Row row;  ///< suite, stage, name, n and problem
  /// Builds kernels and allocates; Error(device) makes the row `unsupported`.
  std::function<Job()> make;
};

}  // namespace clpv::bench
