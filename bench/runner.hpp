// SPDX-License-Identifier: MIT
// Times cases: repetitions in random order among each other, so that what disturbs the machine for a while disturbs all
// alike.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "bench/ceilings.hpp"
#include "bench/job.hpp"
#include "bench/suites.hpp"
#include "support/progress.hpp"

namespace clpv::bench {

inline constexpr int kMostRepetitions = 10000;

/// Rows as they begin and end, a line of JSON each, written as it happens: what a crash, or a kernel that hangs, leaves.
class RowLog {
 public:
  /// Empties the file. Throws Error(run_time) where it cannot be written. No file: nothing is kept.
  explicit RowLog(const std::filesystem::path& file);

  /// {"begun": NAME}: it is being made ready; the last one without its {"row": ...} is what a crash was in.
  void begun(const std::string& name);
  /// {"row": ...}: done, as in the report.
  void done(const Row& row);

 private:
  void write(const std::string& line);
  void check() const;

  std::filesystem::path file_;
  std::ofstream out_;
};

struct RunnerOptions {
  int repetitions = 15;
  const Ceilings* ceilings = nullptr;  ///< rows then tell their share of the one that binds
  Progress* progress = nullptr;        ///< advanced once a case made ready and once a repetition
  RowLog* log = nullptr;               ///< told of rows as they begin and end
};

/// All cases at once: each is set up, run once with the very launches that are then timed (drivers compile at a first
/// launch), timed, and its output checked. In the order of `cases`.
/// Where a user interrupts, Interrupted is thrown after the repetition under way.
/// A wrong output gives Status::wrong, a missing capability Status::unsupported; other errors are thrown.
std::vector<Row> run_cases(Session& session, const std::vector<Case>& cases, const RunnerOptions& options);

struct Results {
  Ceilings ceilings;
  std::vector<Row> rows;
};

struct BenchOptions {
  std::optional<std::regex> filter;  ///< rows whose name it is found in; none: all
  int repetitions = 15;
  SuiteOptions suite;
  std::filesystem::path log;  ///< RowLog's; empty: none
};

/// Measures the ceilings, then the suite's rows. Throws Error(usage) where the filter leaves no row.
Results run_suite(Session& session, const Suite& suite, const BenchOptions& options);

}  // namespace clpv::bench
