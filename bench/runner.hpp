// SPDX-License-Identifier: MIT
// Times cases on Google Benchmark: repetitions in random order among each other, so that what disturbs the machine
// for a while disturbs all alike.
#pragma once

#include <vector>

#include "bench/ceilings.hpp"
#include "bench/job.hpp"
#include "bench/row_log.hpp"
#include "bench/row_watch.hpp"
#include "support/progress.hpp"

namespace clpv::bench {

inline constexpr int kMostRepetitions = 10000;

struct RunnerOptions {
  int repetitions = 15;
  const Ceilings* ceilings = nullptr;  ///< rows then tell their share of the one that binds
  Progress* progress = nullptr;        ///< advanced once a case made ready and once a repetition
  RowWatch* watch = nullptr;           ///< of each case made ready and each repetition
  RowLog* log = nullptr;               ///< told of rows as they begin and end
};

/// All cases at once: each is set up, run once with the very launches that are then timed (drivers compile at a first
/// launch), timed, and its output checked. In the order of `cases`.
/// Where a user interrupts, Interrupted is thrown after the repetition under way.
/// A wrong output gives Status::wrong, a missing capability Status::unsupported; other errors are thrown.
std::vector<Row> run_cases(Session& session, const std::vector<Case>& cases, const RunnerOptions& options);

}  // namespace clpv::bench
