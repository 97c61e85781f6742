// SPDX-License-Identifier: MIT
// A suite from its first case to its rows.
#pragma once

#include <optional>
#include <regex>
#include <vector>

#include "bench/suites.hpp"

namespace clpv::bench {

struct BenchOptions {
  std::optional<std::regex> filter;  ///< rows whose name it is found in; none: all
  int repetitions = 15;
  SuiteOptions suite;
};

struct Results {
  Ceilings ceilings;
  std::vector<Row> rows;
};

/// Measures the ceilings, then the suite's rows. Throws Error(usage) where the filter leaves no row.
Results run_suite(Session& session, const Suite& suite, const BenchOptions& options);

}  // namespace clpv::bench
