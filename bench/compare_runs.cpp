// SPDX-License-Identifier: MIT
// Compares the medians of two reports.
#include "bench/compare_runs.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "support/error.hpp"
#include "support/json_schema.hpp"

namespace clpv::bench {
namespace {

constexpr double kDeviationPerMad = 1.4826;  // standard deviation of a normal distribution over its MAD

void require_report(const nlohmann::json& report, const std::string& file) {
  constexpr double kMax = std::numeric_limits<double>::max();
  const std::vector<Rule> rules = {rule::object(""),
                                   rule::object("/context").must(),
                                   rule::integer("/context/schema", 1, 1).must(),
                                   rule::list("/benchmarks", 0, 1u << 20).must(),
                                   rule::object("/benchmarks/*"),
                                   rule::text("/benchmarks/*/name").must(),
                                   rule::text("/benchmarks/*/status").must(),
                                   rule::number("/benchmarks/*/median", 0, kMax).must(),
                                   rule::number("/benchmarks/*/mad", 0, kMax).must()};
  check_rules(report, rules, file);
}

struct Time {
  double ms, mad;
  bool repeated;  ///< more than once
};

std::map<std::string, Time> times_of(const nlohmann::json& report) {
  std::map<std::string, Time> times;
  for (const nlohmann::json& row : report.at("benchmarks")) {
    if (row.at("status") == "unsupported") continue;
    times[row.at("name")] = {row.at("median"), row.at("mad"), row.value("repetitions", 2) > 1};
  }
  return times;
}

}  // namespace

Comparison compare_runs(const nlohmann::json& before, const nlohmann::json& after, const std::string& file) {
  require_report(before, file);
  const std::map<std::string, Time> old_times = times_of(before), new_times = times_of(after);
  Comparison result;
  for (const nlohmann::json& row : after.at("benchmarks")) {
    const std::string name = row.at("name");
    const auto new_time = new_times.find(name);
    if (new_time == new_times.end()) continue;
    const auto old_time = old_times.find(name);
    if (old_time == old_times.end()) {
      result.only_after.push_back(name);
      continue;
    }
    Change change{name, old_time->second.ms, new_time->second.ms, old_time->second.mad, new_time->second.mad};
    change.spread_known = old_time->second.repeated && new_time->second.repeated;
    const double difference = std::abs(change.after_ms - change.before_ms),
                 deviation = kDeviationPerMad * std::hypot(change.before_mad, change.after_mad);
    change.significant = change.spread_known && difference > kSignificantDeviations * deviation &&
                         difference > kMinRelativeChange * change.before_ms;
    result.changes.push_back(change);
  }
  for (const auto& [name, time] : old_times) {
    if (!new_times.contains(name)) result.only_before.push_back(name);
  }
  return result;
}

void require_ratios(const Comparison& comparison, double limit) {
  std::vector<std::string> slower;
  for (const Change& change : comparison.changes) {
    if (change.ratio() > limit && (change.significant || !change.spread_known))
      slower.push_back(fmt::format("{} ({:.3f})", change.name, change.ratio()));
  }
  if (slower.empty()) return;
  throw Error(ExitCode::validation, "{} of {} rows take more than {} times as long as before: {}",
              slower.size(), comparison.changes.size(), limit, fmt::join(slower, ", "));
}

std::string comparison_table(const Comparison& comparison) {
  std::size_t width = 3;
  for (const Change& change : comparison.changes) width = std::max(width, change.name.size());
  std::string text =
      fmt::format("{:<{}} {:>22} {:>22} {:>8}\n", "row", width, "before [ms]", "after [ms]", "ratio");
  for (const Change& change : comparison.changes) {
    const char* verdict = !change.spread_known  ? "spread unknown"
                          : !change.significant ? "within the spread"
                          : change.ratio() > 1  ? "SLOWER"
                                                : "faster";
    text += fmt::format("{:<{}} {:>22} {:>22} {:>8.3f} {}\n", change.name, width,
                        fmt::format("{:.4f} +- {:.4f}", change.before_ms, change.before_mad),
                        fmt::format("{:.4f} +- {:.4f}", change.after_ms, change.after_mad), change.ratio(),
                        verdict);
  }
  for (const std::string& name : comparison.only_before)
    text += fmt::format("{}: only in the earlier run\n", name);
  for (const std::string& name : comparison.only_after) text += fmt::format("{}: only in this run\n", name);
  return text;
}

}  // namespace clpv::bench
