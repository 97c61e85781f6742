// SPDX-License-Identifier: MIT
// Times cases. Repetitions of all cases run in random order, so that a disturbance of the machine
// affects all equally.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "bench/row.hpp"
#include "bench/suites.hpp"
#include "support/progress.hpp"

namespace clpv::bench {

inline constexpr int kMaxRepetitions = 10000;

/// Log with a line of JSON at the start and the end of each row, flushed at once. It survives
/// crashes and hangs.
class RowLog {
 public:
  /// Truncates the file; an empty path disables the log. Throws Error(run_time) if the file cannot
  /// be written.
  explicit RowLog(const std::filesystem::path& file);

  /// Writes {"started": NAME}, before the row's setup. After a crash, the last one without a
  /// {"row": ...} names the row.
  void started(const std::string& name);
  /// Writes {"row": ...}, as in the report.
  void done(const Row& row);

 private:
  void write(const std::string& line);
  void check() const;

  std::filesystem::path file_;
  std::ofstream out_;
};

struct RunnerOptions {
  int repetitions = 15;
  /// Advances once per case set up and once per repetition; may be null.
  Progress* progress = nullptr;
  RowLog* log = nullptr;  ///< may be null
};

/// Sets up every case and runs it once, as drivers compile at the first launch. Then times all
/// cases interleaved and verifies their outputs. Returns rows in the order of `cases`. A wrong
/// output gives Status::wrong, a missing capability Status::unsupported. Throws all other errors,
/// and Interrupted after the current repetition if the user interrupts.
std::vector<Row> run_cases(Session& session, const std::vector<Case>& cases,
                           const RunnerOptions& options);

struct BenchOptions {
  std::optional<std::regex> filter;  ///< searched in row names; empty: all rows
  int repetitions = 15;
  SuiteOptions suite;
  std::filesystem::path log;  ///< file of the RowLog; empty: no log
};

/// Measures the suite's rows. Throws Error(usage) if the filter matches no row.
std::vector<Row> run_suite(Session& session, const Suite& suite, const BenchOptions& options);

}  // namespace clpv::bench
