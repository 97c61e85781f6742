// SPDX-License-Identifier: MIT
// What a benchmark times: work on a device that can be repeated, checked and counted.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/row.hpp"
#include "device/session.hpp"

namespace clpv::bench {

/// The timed output against its reference.
struct Deviation {
  double worst = 0, tolerance = 0;
  std::string place;
  bool passed() const { return worst <= tolerance; }  // false for NaN
};

struct Job {
  std::function<void()> reset;        ///< before each repetition, untimed: clears what the work writes
  std::function<void()> run;          ///< enqueues the work
  std::function<Deviation()> verify;  ///< of the last repetition's output; none: nothing to compare
  Cost cost;
  bool own_stages = false;  ///< `run` marks stages on the timeline itself; its time is then wall time
  std::function<void(const std::vector<StageTime>&)>
      after_run;                                          ///< of each run, warm-up included; may be none
  std::function<std::vector<Row>(const Row&)> more_rows;  ///< to stand after the job's own; may be none
};

/// A row to be: its identity, and how to set up its work.
struct Case {
  Row row;                    ///< suite, stage, name, n and variant
  std::function<Job()> make;  ///< builds kernels, takes memory. Error(device): the row is `unsupported`
};

}  // namespace clpv::bench
