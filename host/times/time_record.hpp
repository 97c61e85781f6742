// SPDX-License-Identifier: MIT
// Writes and reads the records of times (clpv/time_record.hpp).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "clpv/time_record.hpp"
#include "device/timeline.hpp"
#include "support/json_optional.hpp"
#include "support/json_schema.hpp"

namespace clpv {

// Statistics of measurements.

/// Statistics of a series, in its unit. All 0 for an empty series.
struct Statistics {
  double min = 0, median = 0, p95 = 0, max = 0;
  double mad = 0;  ///< median absolute deviation from the median, robust against outliers
};

/// Quantiles interpolate linearly between the sorted samples; the first is quantile 0, the last
/// quantile 1.
Statistics statistics_of(std::vector<double> samples);

inline double median(std::vector<double> samples) {
  return statistics_of(std::move(samples)).median;
}

TimeRecord time_record(std::string stage, std::vector<double> samples_ms);
TimeRecord time_record(const StageMark& mark, std::vector<double> samples_ms);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TimeRecord, stage, cascade, light, n, min, median, mad, max)
/// Rules of records at a place, for example "/times/*"; from_json() reads what passes them.
std::vector<Rule> time_rules(const std::string& place);

/// "gather", "gather/cascade:1", "rasterize-rsm/cascade:1", "rasterize-shadow/light:0"
std::string name_of(const TimeRecord& record);

}  // namespace clpv
