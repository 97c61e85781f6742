// SPDX-License-Identifier: MIT
// Comparison of two runs of a suite: changes of time that exceed the spread of both runs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace clpv::bench {

struct Change {
  std::string name;
  double before_ms = 0, after_ms = 0;    ///< medians
  double before_mad = 0, after_mad = 0;  ///< median absolute deviations [ms]
  /// False if a run has a single repetition, whose deviation is unknown.
  bool spread_known = true;
  /// True if the spread is known and the difference exceeds both kSignificantDeviations standard deviations (1.4826 MAD each, added in quadrature) and
  /// kMinRelativeChange of the time before.
  bool significant = false;
  double ratio() const { return before_ms > 0 ? after_ms / before_ms : 0; }
};

inline constexpr double kSignificantDeviations = 3;
inline constexpr double kMinRelativeChange = 0.02;

struct Comparison {
  std::vector<Change> changes;                       ///< rows timed in both runs, in the order of the new run
  std::vector<std::string> only_before, only_after;  ///< names of the other rows
};

/// Compares two reports (report_json). Throws Error(bad_input) if `before`, read from `file`, is no report of schema 1.
Comparison compare_runs(const nlohmann::json& before, const nlohmann::json& after, const std::string& file);

/// Throws Error(validation) that names the rows whose ratio exceeds `limit`: beyond the spread, or with unknown spread.
void require_ratios(const Comparison& comparison, double limit);

/// Text with one line per change: medians with MAD, ratio and verdict. Rows of only one run follow.
std::string comparison_table(const Comparison& comparison);

}  // namespace clpv::bench
