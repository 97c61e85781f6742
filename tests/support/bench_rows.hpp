// SPDX-License-Identifier: MIT
// Small runs of suites of `clpv bench`.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include "bench/runner.hpp"
#include "bench/suites.hpp"
#include "tests/support/on_device.hpp"

namespace clpv::bench {

/// Small enough that compiling dominates the time.
inline SuiteOptions small() {
  SuiteOptions options;
  options.settings.grid = 16, options.settings.rsm_size = 64, options.settings.shadow_size = 128;
  options.settings.width = 96, options.settings.height = 54;
  return options;
}

/// Rows of a suite in whose names `filter` is found, timed once on the tests' device.
inline std::vector<Row> rows_of(const Suite& suite, const std::string& filter,
                                const SuiteOptions& options = small()) {
  std::vector<Row> rows;
  for (const Group& group : suite.groups(test::test_session(), options)) {
    std::vector<Case> cases = group();
    std::erase_if(
        cases, [&](const Case& c) { return !std::regex_search(c.row.name, std::regex(filter)); });
    std::ranges::move(run_cases(test::test_session(), cases, {.repetitions = 1}),
                      std::back_inserter(rows));
  }
  return rows;
}

inline std::vector<std::string> names_of(const std::vector<Row>& rows) {
  std::vector<std::string> names;
  for (const Row& row : rows) names.push_back(row.name);
  return names;
}

inline void expect_right(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    EXPECT_EQ(row.status, Status::ok) << row.name << ": " << row.reason;
    EXPECT_LE(row.max_rel_error.value_or(0), row.tolerance) << row.name;
  }
}

}  // namespace clpv::bench
