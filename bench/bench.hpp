// SPDX-License-Identifier: MIT
// A suite from its first case to its rows.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <regex>
#include <vector>

#include "bench/suites.hpp"

namespace clpv::bench {

struct Results {
  Ceilings ceilings;
  std::vector<Row> rows;
};

struct BenchOptions {
  std::optional<std::regex> filter;  ///< rows whose name it is found in; none: all
  int repetitions = 15;
  SuiteOptions suite;
  double row_limit = 0;       ///< [s] that a row may take to be made ready, or to be run once; 0: none
  std::filesystem::path log;  ///< row_log.hpp; empty: none
  /// Called on a thread of its own with what there is, the last row being the one that exceeded the limit. The process
  /// ends when it returns.
  std::function<void(const Results&)> hung;
};

/// Measures the ceilings, then the suite's rows. Throws Error(usage) where the filter leaves no row.
Results run_suite(Session& session, const Suite& suite, const BenchOptions& options);

}  // namespace clpv::bench
