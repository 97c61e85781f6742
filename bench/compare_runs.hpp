// SPDX-License-Identifier: MIT
// Comparison of two reports of one kind: changes that exceed the spread of both. Reports are those
// of `clpv bench`, of `clpv quality`, and the statistics of `clpv render --stats`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace clpv::bench {

struct Change {
  std::string name;
  double before = 0, after = 0;  ///< median times [ms], or errors
  /// Median absolute deviations; 0 for errors, which repeat exactly.
  double before_mad = 0, after_mad = 0;
  /// False if a report has no deviation, as from a single repetition.
  bool spread_known = true;
  /// True if the spread is known and the difference exceeds both kSignificantDeviations standard
  /// deviations (1.4826 MAD each, added in quadrature) and kMinRelativeChange of the value before.
  bool significant = false;
  double ratio() const { return before > 0 ? after / before : 0; }
};

inline constexpr double kSignificantDeviations = 3;
inline constexpr double kMinRelativeChange = 0.02;

struct ReportChanges {
  std::vector<Change> changes;  ///< rows of both reports, in the order of the new one
  std::vector<std::string> only_before, only_after;  ///< names of the other rows
};

/// Compares two reports. Throws Error(bad_input) if one is no report of schema 1, or if their kinds
/// differ. `file`, `after_file`: where they are from, for errors.
ReportChanges compare_runs(const nlohmann::json& before, const nlohmann::json& after,
                           const std::string& file, const std::string& after_file = "this run");

/// Throws Error(validation) that names the rows whose ratio exceeds `limit`: beyond the spread, or
/// with unknown spread.
void require_ratios(const ReportChanges& found, double limit);

/// Text with one line per change: medians with MAD, ratio and verdict. Rows of only one run follow.
std::string changes_table(const ReportChanges& found);

}  // namespace clpv::bench
