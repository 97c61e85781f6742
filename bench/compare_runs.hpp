// SPDX-License-Identifier: MIT
// Two runs of a suite against each other: what changed by more than their spread.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace clpv::bench {

struct Change {
  std::string name;
  double before_ms = 0, after_ms = 0;    ///< medians
  double before_mad = 0, after_mad = 0;  ///< their spread
  /// More than the spreads of both allow: kClearDeviations standard deviations of the difference, as the median
  /// absolute deviations tell them, and kLeastChange of the time.
  bool clear = false;
  double ratio() const { return before_ms > 0 ? after_ms / before_ms : 0; }
};

inline constexpr double kClearDeviations = 3;
inline constexpr double kLeastChange = 0.02;

struct Comparison {
  std::vector<Change> changes;                       ///< of rows timed in both, in the order of the new run
  std::vector<std::string> only_before, only_after;  ///< names of the others
};

/// Of two reports (report_json). Throws Error(bad_input) where `before`, read from `file`, is none of schema 1.
Comparison compare_runs(const nlohmann::json& before, const nlohmann::json& after, const std::string& file);

/// A line a change: medians with their spread, the ratio, and whether it is clear; then rows of one run alone.
std::string comparison_table(const Comparison& comparison);

}  // namespace clpv::bench
