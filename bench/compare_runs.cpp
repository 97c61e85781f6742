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

// Standard deviation of a normal distribution over its MAD.
constexpr double kDeviationPerMad = 1.4826;

constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kMaxRows = 1u << 20;

struct Value {
  std::string name;
  double value, mad = 0;
  bool repeated = true;  ///< more than once: `mad` is known
};

std::vector<Value> values_of_bench(const nlohmann::json& report, const std::string& file) {
  const std::vector<Rule> rules = {rule::object(""),
                                   rule::object("/context").must(),
                                   rule::integer("/context/schema", 1, 1).must(),
                                   rule::list("/benchmarks", 0, kMaxRows).must(),
                                   rule::object("/benchmarks/*"),
                                   rule::text("/benchmarks/*/name").must(),
                                   rule::text("/benchmarks/*/status").must(),
                                   rule::number("/benchmarks/*/median", 0, kMax).must(),
                                   rule::number("/benchmarks/*/mad", 0, kMax).must()};
  check_rules(report, rules, file);
  std::vector<Value> values;
  for (const nlohmann::json& row : report.at("benchmarks")) {
    if (row.at("status") != "unsupported")
      values.push_back(
          {row.at("name"), row.at("median"), row.at("mad"), row.value("repetitions", 2) > 1});
  }
  return values;
}

/// Errors and times of the cells; rejected cells have none.
std::vector<Value> values_of_quality(const nlohmann::json& report, const std::string& file) {
  const std::vector<Rule> rules = {rule::object(""),
                                   rule::list("/cells", 0, kMaxRows).must(),
                                   rule::object("/cells/*"),
                                   rule::text("/cells/*/scene").must(),
                                   rule::text("/cells/*/camera").must(),
                                   rule::text("/cells/*/rejected").must(),
                                   rule::object("/cells/*/options").must(),
                                   rule::text("/cells/*/options/*"),
                                   rule::number("/cells/*/frame_ms", 0, kMax).must()};
  check_rules(report, rules, file);
  std::vector<Value> values;
  for (const nlohmann::json& cell : report.at("cells")) {
    if (cell.at("rejected") != "") continue;
    std::string name = fmt::format("{}:{}", cell.at("scene").get<std::string>(),
                                   cell.at("camera").get<std::string>());
    for (const auto& [option, value] : cell.at("options").items())
      name += fmt::format(" {}={}", option, value.get<std::string>());
    if (const auto nrmse = cell.find("nrmse"); nrmse != cell.end() && nrmse->is_number())
      values.push_back({name + " nrmse", *nrmse});
    values.push_back({name + " frame", cell.at("frame_ms"), 0, false});
  }
  return values;
}

/// Times of the frame and of its stages.
std::vector<Value> values_of_stats(const nlohmann::json& report, const std::string& file) {
  const std::vector<Rule> rules = {rule::object(""),
                                   rule::number("/frame_ms", 0, kMax).must(),
                                   rule::list("/stages", 0, kMaxRows).must(),
                                   rule::object("/stages/*"),
                                   rule::text("/stages/*/stage").must(),
                                   rule::number("/stages/*/ms", 0, kMax).must()};
  check_rules(report, rules, file);
  std::vector<Value> values = {{"frame", report.at("frame_ms"), 0, false}};
  for (const nlohmann::json& stage : report.at("stages")) {
    std::string name = stage.at("stage");
    for (const char* part : {"cascade", "light"}) {  // null in stages of all
      if (const auto number = stage.find(part);
          number != stage.end() && number->is_number_integer())
        name += fmt::format("/{}:{}", part, number->get<int>());
    }
    values.push_back({name, stage.at("ms"), 0, false});
  }
  return values;
}

/// A kind of report: its command, a key that only it has, and its values.
struct Kind {
  const char *command, *key;
  std::vector<Value> (*values)(const nlohmann::json&, const std::string&);
};

constexpr Kind kKinds[] = {{"clpv bench", "benchmarks", values_of_bench},
                           {"clpv quality", "cells", values_of_quality},
                           {"clpv render --stats", "stages", values_of_stats}};

const Kind& kind_of(const nlohmann::json& report, const std::string& file) {
  for (const Kind& kind : kKinds) {
    if (report.is_object() && report.contains(kind.key)) return kind;
  }
  throw Error(ExitCode::bad_input,
              "{}: no report; allowed: JSON of clpv bench, clpv quality or clpv render --stats",
              file);
}

std::map<std::string, Value> by_name(const std::vector<Value>& values) {
  std::map<std::string, Value> map;
  for (const Value& value : values) map[value.name] = value;
  return map;
}

Change change_of(const Value& before, const Value& after) {
  Change change{after.name, before.value, after.value, before.mad, after.mad};
  change.spread_known = before.repeated && after.repeated;
  const double difference = std::abs(change.after - change.before),
               deviation = kDeviationPerMad * std::hypot(change.before_mad, change.after_mad);
  change.significant = change.spread_known && difference > kSignificantDeviations * deviation &&
                       difference > kMinRelativeChange * change.before;
  return change;
}

/// "12.3400 +- 0.0500"; errors and single repetitions have no spread.
std::string with_spread(double value, double mad) {
  return mad > 0 ? fmt::format("{:.4f} +- {:.4f}", value, mad) : fmt::format("{:.4f}", value);
}

}  // namespace

ReportChanges compare_runs(const nlohmann::json& before, const nlohmann::json& after,
                           const std::string& file, const std::string& after_file) {
  const Kind &kind = kind_of(before, file), &after_kind = kind_of(after, after_file);
  if (&kind != &after_kind)
    throw Error(ExitCode::bad_input, "{} is of {}, {} of {}; allowed: two reports of one command",
                file, kind.command, after_file, after_kind.command);
  const std::vector<Value> old_values = kind.values(before, file),
                           new_values = kind.values(after, after_file);
  const std::map<std::string, Value> old_named = by_name(old_values),
                                     new_named = by_name(new_values);
  ReportChanges result;
  for (const Value& value : new_values) {
    const auto old_value = old_named.find(value.name);
    if (old_value == old_named.end())
      result.only_after.push_back(value.name);
    else
      result.changes.push_back(change_of(old_value->second, value));
  }
  for (const Value& value : old_values) {
    if (!new_named.contains(value.name)) result.only_before.push_back(value.name);
  }
  return result;
}

void require_ratios(const ReportChanges& found, double limit) {
  std::vector<std::string> slower;
  for (const Change& change : found.changes) {
    if (change.ratio() > limit && (change.significant || !change.spread_known))
      slower.push_back(fmt::format("{} ({:.3f})", change.name, change.ratio()));
  }
  if (slower.empty()) return;
  throw Error(ExitCode::validation, "{} of {} rows have more than {} times their earlier value: {}",
              slower.size(), found.changes.size(), limit, fmt::join(slower, ", "));
}

std::string changes_table(const ReportChanges& found) {
  std::size_t width = 3;
  for (const Change& change : found.changes) width = std::max(width, change.name.size());
  std::string text =
      fmt::format("{:<{}} {:>22} {:>22} {:>8}\n", "row", width, "before", "after", "ratio");
  for (const Change& change : found.changes) {
    const char* verdict = !change.spread_known  ? "spread unknown"
                          : !change.significant ? "within the spread"
                          : change.ratio() > 1  ? "HIGHER"
                                                : "lower";
    text += fmt::format("{:<{}} {:>22} {:>22} {:>8.3f} {}\n", change.name, width,
                        with_spread(change.before, change.before_mad),
                        with_spread(change.after, change.after_mad), change.ratio(), verdict);
  }
  for (const std::string& name : found.only_before)
    text += fmt::format("{}: only in the earlier run\n", name);
  for (const std::string& name : found.only_after)
    text += fmt::format("{}: only in this run\n", name);
  return text;
}

}  // namespace clpv::bench
