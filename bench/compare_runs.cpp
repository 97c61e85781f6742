// SPDX-License-Identifier: MIT
#include "bench/compare_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "support/json_schema.hpp"

namespace clpv::bench {
namespace {

constexpr double kPerMad = 1.4826;  // standard deviations of a normal distribution in one MAD

void require_report(const nlohmann::json& report, const std::string& file) {
  constexpr double kMost = std::numeric_limits<double>::max();
  const std::vector<Rule> rules = {rule::object(""),
                                   rule::object("/context").must(),
                                   rule::integer("/context/schema", 1, 1).must(),
                                   rule::list("/benchmarks", 0, 1u << 20).must(),
                                   rule::object("/benchmarks/*"),
                                   rule::text("/benchmarks/*/name").must(),
                                   rule::text("/benchmarks/*/status").must(),
                                   rule::number("/benchmarks/*/median", 0, kMost).must(),
                                   rule::number("/benchmarks/*/mad", 0, kMost).must()};
  check_rules(report, rules, file);
}

struct Time {
  double ms, mad;
};

std::map<std::string, Time> times_of(const nlohmann::json& report) {
  std::map<std::string, Time> times;
  for (const nlohmann::json& row : report.at("benchmarks")) {
    if (row.at("status") == "unsupported") continue;
    times[row.at("name")] = {row.at("median"), row.at("mad")};
  }
  return times;
}

}  // namespace

Comparison compare_runs(const nlohmann::json& before, const nlohmann::json& after, const std::string& file) {
  require_report(before, file);
  const std::map<std::string, Time> old = times_of(before), now = times_of(after);
  Comparison result;
  for (const nlohmann::json& row : after.at("benchmarks")) {
    const std::string name = row.at("name");
    const auto found = now.find(name);
    if (found == now.end()) continue;
    const auto was = old.find(name);
    if (was == old.end()) {
      result.only_after.push_back(name);
      continue;
    }
    Change change{name, was->second.ms, found->second.ms, was->second.mad, found->second.mad};
    const double difference = std::abs(change.after_ms - change.before_ms);
    change.clear =
        difference > kClearDeviations * kPerMad * std::hypot(change.before_mad, change.after_mad) &&
        difference > kLeastChange * change.before_ms;
    result.changes.push_back(change);
  }
  for (const auto& [name, time] : old) {
    if (!now.contains(name)) result.only_before.push_back(name);
  }
  return result;
}

std::string comparison_table(const Comparison& comparison) {
  std::size_t width = 3;
  for (const Change& change : comparison.changes) width = std::max(width, change.name.size());
  std::string text =
      fmt::format("{:<{}} {:>22} {:>22} {:>8}\n", "row", width, "before [ms]", "after [ms]", "ratio");
  for (const Change& change : comparison.changes) {
    const char* verdict = !change.clear ? "within the spread" : change.ratio() > 1 ? "SLOWER" : "faster";
    text += fmt::format("{:<{}} {:>22} {:>22} {:>8.3f} {}\n", change.name, width,
                        fmt::format("{:.4f} +- {:.4f}", change.before_ms, change.before_mad),
                        fmt::format("{:.4f} +- {:.4f}", change.after_ms, change.after_mad), change.ratio(),
                        verdict);
  }
  for (const std::string& name : comparison.only_before) text += fmt::format("{}: only before\n", name);
  for (const std::string& name : comparison.only_after) text += fmt::format("{}: only now\n", name);
  return text;
}

}  // namespace clpv::bench
