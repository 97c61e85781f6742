// SPDX-License-Identifier: MIT
// Comparison of two reports of one kind: changes that exceed the spread of both. Reports are those
// of `clpv bench`, of `clpv quality`, and the statistics of `clpv render --stats`.
#pragma once

#include <limits>
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
  /// Infinite if only the value before is 0.
  double ratio() const {
    if (before > 0) return after / before;
    return after > 0 ? std::numeric_limits<double>::infinity() : 1;
  }
};

inline constexpr double kSignificantDeviations = 3;
inline constexpr double kMinRelativeChange = 0.02;

/// A row of the earlier report that has no value in the new one.
struct LostRow {
  std::string name, reason;  ///< "not in this run", "rejected", "wrong", "undefined", ...
};

struct ReportChanges {
  std::vector<Change> changes;  ///< rows with a value in both reports, in the order of the new one
  std::vector<LostRow> lost;
  std::vector<std::string> added;      ///< names of rows with a value in the new report only
  std::vector<std::string> undefined;  ///< names of rows without a value in both
};

/// Compares two reports. Throws Error(bad_input) if one is no report of schema 1, or if their kinds
/// differ. `file`, `after_file`: where they are from, for errors.
ReportChanges compare_runs(const nlohmann::json& before, const nlohmann::json& after,
                           const std::string& file, const std::string& after_file = "this run");

/// Throws Error(validation) if no row has a value in both reports. With a `limit` above 0 also
/// names the lost rows, and those whose ratio exceeds it, beyond the spread or with unknown spread.
void require_ratios(const ReportChanges& found, double limit);

/// Text with one line per change: medians with MAD, ratio and verdict. The other rows follow.
std::string changes_table(const ReportChanges& found);

}  // namespace clpv::bench
