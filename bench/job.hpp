// SPDX-License-Identifier: MIT
// Jobs of a benchmark: work on a device that can be repeated and verified, and whose cost is counted.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/row.hpp"
#include "device/session.hpp"

namespace clpv::bench {

/// Largest relative deviation of the timed output from its reference.
struct Deviation {
  double worst = 0, tolerance = 0;
  std::string place;                                  ///< of the largest deviation, for messages
  bool passed() const { return worst <= tolerance; }  // false for NaN
};

struct Job {
  std::function<void()> reset;        ///< clears outputs before each repetition, untimed; may be null
  std::function<void()> run;          ///< enqueues the work
  std::function<Deviation()> verify;  ///< checks the last repetition's output; null: no reference
  Cost cost;
  bool own_stages = false;  ///< true: `run` marks stages on the timeline itself, and the row has wall times
  std::function<void(const std::vector<StageTime>&)>
      after_run;  ///< called after each run, warm-up included; may be null
  std::function<std::vector<Row>(const Row&)> more_rows;  ///< further rows, after the job's own; may be null
};

/// A row before its measurement: its identity, and a function that sets up its work.
struct Case {
  Row row;                    ///< suite, stage, name, n and variant
  std::function<Job()> make;  ///< builds kernels and allocates; Error(device) makes the row `unsupported`
};

}  // namespace clpv::bench
