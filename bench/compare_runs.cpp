// SPDX-License-Identifier: MIT
// Compares the medians of two reports.
#include "bench/compare_runs.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "support/error.hpp"
#include "support/json_optional.hpp"
#include "support/json_schema.hpp"
#include "support/log.hpp"
#include "times/time_record.hpp"

namespace clpv::bench {
namespace {

// Standard deviation of a normal distribution over its MAD.
constexpr double kDeviationPerMad = 1.4826;

constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kMaxRows = 1u << 20;

struct Value {
  std::string name;
  std::optional<double> value;
  double mad = 0;
  bool repeated = false;       ///< more than once: `mad` is known
  std::string undefined = {};  ///< reason if there is no value
};

Value value_of(std::string name, const TimeRecord& time) {
  return {std::move(name), time.median, time.mad, time.n > 1};
}

std::vector<Value> values_of_bench(const nlohmann::json& rows) {
  std::vector<Value> values;
  for (const nlohmann::json& row : rows) {
    if (row.at("status") == "ok")
      values.push_back(value_of(row.at("name"), row));
    else
      values.push_back({row.at("name"), {}, 0, false, row.at("status")});
    if (row.value("launches", 0.0) == 0) continue;  // a kernel of a frame
    for (const char* number : {"launches", "fills", "waits", "arguments", "written"})
      values.push_back({fmt::format("{} {}", row.at("name").get<std::string>(), number),
                        row.at(number).get<double>(), 0, true});  // it repeats exactly
  }
  return values;
}

/// Errors and times of the cells; rejected cells have none.
std::vector<Value> values_of_quality(const nlohmann::json& cells) {
  std::vector<Value> values;
  for (const nlohmann::json& cell : cells) {
    std::string name = fmt::format("{}:{}", cell.at("scene").get<std::string>(),
                                   cell.at("camera").get<std::string>());
    for (const auto& [option, value] : cell.at("options").items())
      name += fmt::format(" {}={}", option, value.get<std::string>());
    const bool rejected = cell.at("rejected") != "";
    if (rejected) {
      for (const char* of : {" nrmse", " frame"})
        values.push_back({name + of, {}, 0, false, "rejected"});
      continue;
    }
    const auto nrmse = cell.at("nrmse").get<std::optional<double>>();
    values.push_back({name + " nrmse", nrmse, 0, true, "undefined"});  // it repeats exactly
    for (const TimeRecord time : cell.at("times"))
      if (time.stage == "frame") values.push_back(value_of(name + " frame", time));
  }
  return values;
}

std::vector<Value> values_of_stats(const nlohmann::json& times) {
  std::vector<Value> values;
  for (const TimeRecord time : times) values.push_back(value_of(name_of(time), time));
  return values;
}

/// A kind of report: its command, the list of its rows, which only it has, the place of its
/// records, and the values of the rows.
struct Kind {
  const char *command, *key, *records;
  std::vector<Value> (*values)(const nlohmann::json& rows);
  std::vector<Rule> rules;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"clpv bench",
       "benchmarks",
       "/benchmarks/*",
       values_of_bench,
       {rule::object("/context").must(), rule::integer("/context/schema", 2, 2).must(),
        rule::text("/benchmarks/*/name").must(), rule::text("/benchmarks/*/status").must()}},
      {"clpv quality",
       "cells",
       "/cells/*/times/*",
       values_of_quality,
       {rule::object("/cells/*"), rule::text("/cells/*/scene").must(),
        rule::text("/cells/*/camera").must(), rule::text("/cells/*/rejected").must(),
        rule::object("/cells/*/options").must(), rule::text("/cells/*/options/*"),
        rule::number("/cells/*/nrmse", 0, kMax).must().or_null(),
        rule::list("/cells/*/times", 0, kMaxRows).must()}},
      {"clpv render --stats", "times", "/times/*", values_of_stats, {}}};
  return all;
}

const Kind& kind_of(const nlohmann::json& report, const std::string& file) {
  for (const Kind& kind : kinds()) {
    if (report.is_object() && report.contains(kind.key)) return kind;
  }
  throw Error(ExitCode::bad_input,
              "{}: no report; allowed: JSON of clpv bench, clpv quality or clpv render --stats",
              file);
}

std::vector<Value> values_of(const Kind& kind, const nlohmann::json& report,
                             const std::string& file) {
  std::vector<Rule> rules = kind.rules;
  rules.push_back(rule::list(fmt::format("/{}", kind.key), 0, kMaxRows));
  std::ranges::move(time_rules(kind.records), std::back_inserter(rules));
  check_rules(report, rules, file);
  return kind.values(report.at(kind.key));
}

/// Values by name. Further ones of a name get its number: "gather (2)". Warns of them.
std::map<std::string, Value> by_name(std::vector<Value>& values, const std::string& file) {
  std::map<std::string, int> counts;
  std::map<std::string, Value> map;
  for (Value& value : values) {
    const int number = ++counts[value.name];
    if (number == 2)
      log_warning("{}: several rows '{}': compared in their order", file, value.name);
    if (number > 1) value.name += fmt::format(" ({})", number);
    map[value.name] = value;
  }
  return map;
}

Change change_of(const Value& before, const Value& after) {
  Change change{after.name, *before.value, *after.value, before.mad, after.mad};
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
  if (before.contains("view") && after.contains("view") && before["view"] != after["view"])
    throw Error(ExitCode::bad_input, "{} is of view {}, {} of {}; allowed: reports of one view",
                file, before["view"].dump(), after_file, after["view"].dump());
  std::vector<Value> old_values = values_of(kind, before, file),
                     new_values = values_of(kind, after, after_file);
  const std::map<std::string, Value> old_named = by_name(old_values, file),
                                     new_named = by_name(new_values, after_file);
  ReportChanges result;
  for (const Value& value : new_values) {
    const auto old_value = old_named.find(value.name);
    const bool old = old_value != old_named.end() && old_value->second.value;
    if (old && value.value)
      result.changes.push_back(change_of(old_value->second, value));
    else if (old)
      result.lost.push_back({value.name, value.undefined});
    else
      (value.value ? result.added : result.undefined).push_back(value.name);
  }
  for (const Value& value : old_values) {
    if (new_named.contains(value.name)) continue;
    if (value.value)
      result.lost.push_back({value.name, "not in this run"});
    else
      result.undefined.push_back(value.name);
  }
  return result;
}

void require_ratios(const ReportChanges& found, double limit) {
  std::vector<std::string> slower, lost, problems;
  if (limit > 0) {
    for (const Change& change : found.changes) {
      if (change.ratio() > limit && (change.significant || !change.spread_known))
        slower.push_back(fmt::format("{} ({:.3f})", change.name, change.ratio()));
    }
    for (const LostRow& row : found.lost)
      lost.push_back(fmt::format("{} ({})", row.name, row.reason));
  }
  if (!slower.empty())
    problems.push_back(fmt::format("{} of {} rows have more than {} times their earlier value: {}",
                                   slower.size(), found.changes.size(), limit,
                                   fmt::join(slower, ", ")));
  if (!lost.empty())
    problems.push_back(
        fmt::format("{} rows have lost their value: {}", lost.size(), fmt::join(lost, ", ")));
  if (found.changes.empty())
    problems.push_back("no row has a value in both reports; allowed: one or more");
  if (problems.empty()) return;
  throw Error(ExitCode::validation, "{}", fmt::join(problems, "; "));
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
  for (const LostRow& row : found.lost) text += fmt::format("{}: LOST: {}\n", row.name, row.reason);
  for (const std::string& name : found.added) text += fmt::format("{}: only in this run\n", name);
  for (const std::string& name : found.undefined)
    text += fmt::format("{}: - (undefined in both)\n", name);
  return text;
}

}  // namespace clpv::bench
