// SPDX-License-Identifier: MIT
// Comparison of two reports of one kind: changes that exceed the spread of both. Reports are those
// of `clpv bench`, of `clpv quality`, and the statistics of `clpv render --stats`.
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "support/error.hpp"
#include "support/json_optional.hpp"
#include "support/json_schema.hpp"
#include "support/log.hpp"
#include "times/time_record.hpp"

namespace clpv {
namespace reports {

// Standard deviation of a normal distribution over its MAD.
constexpr double kDeviationPerMad = 1.4826;
// A change is significant beyond this many standard deviations of both values, added in quadrature,
// and beyond this part of the value before.
constexpr double kSignificantDeviations = 3;
constexpr double kMinRelativeChange = 0.02;

constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kMaxRows = 1u << 20;

/// A median time [ms], a count or an error of a row.
struct Value {
  std::string name;
  std::optional<double> value;
  std::optional<double> mad = 0;  ///< none: a single repetition, whose spread is unknown
  std::string undefined = {};     ///< reason if there is no value
};

Value value_of(std::string name, const TimeRecord& time) {
  return {std::move(name), time.median, time.n > 1 ? std::optional(time.mad) : std::nullopt};
}

std::vector<Value> values_of_bench(const nlohmann::json& rows) {
  std::vector<Value> values;
  for (const nlohmann::json& row : rows) {
    if (row.at("status") == "ok")
      values.push_back(value_of(row.at("name"), row));
    else
      values.push_back({row.at("name"), {}, 0, row.at("status")});
    if (row.value("launches", 0.0) == 0) continue;  // a kernel of a frame
    for (const char* number : {"launches", "fills", "waits", "arguments", "written"})
      values.push_back({fmt::format("{} {}", row.at("name").get<std::string>(), number),
                        row.at(number).get<double>()});
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
      for (const char* of : {" nrmse", " frame"}) values.push_back({name + of, {}, 0, "rejected"});
      continue;
    }
    const auto nrmse = cell.at("nrmse").get<std::optional<double>>();
    values.push_back({name + " nrmse", nrmse, 0, "undefined"});
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

/// Values of a report. Further ones of a name get their number: "gather (2)".
std::vector<Value> values_of(const Kind& kind, const nlohmann::json& report,
                             const std::string& file) {
  std::vector<Rule> rules = kind.rules;
  rules.push_back(rule::list(fmt::format("/{}", kind.key), 0, kMaxRows));
  std::ranges::move(time_rules(kind.records), std::back_inserter(rules));
  check_rules(report, rules, file);
  std::vector<Value> values = kind.values(report.at(kind.key));
  std::map<std::string, int> counts;
  for (Value& value : values)
    if (const int number = ++counts[value.name]; number > 1)
      value.name += fmt::format(" ({})", number);
  return values;
}

/// "12.3400 +- 0.0500"; errors and single repetitions have no spread.
std::string with_spread(const Value& value) {
  return value.mad.value_or(0) > 0 ? fmt::format("{:.4f} +- {:.4f}", *value.value, *value.mad)
                                   : fmt::format("{:.4f}", *value.value);
}

/// Compares reports row by row.
struct Comparer {
  double limit;  ///< ratio that fails; 0: none
  std::size_t width = 3, compared = 0;
  std::string lines = {};
  std::vector<std::string> slower = {}, lost = {};

  void add(const Value* before, const Value* after) {
    const std::string& name = (after ? after : before)->name;
    const bool was = before && before->value, is = after && after->value;
    if (was && is)
      add_change(*before, *after);
    else if (was)
      add_lost(name, after ? after->undefined : "not in this run");
    else
      lines += fmt::format("{}: {}\n", name, is ? "only in this run" : "- (undefined in both)");
  }

  void add_lost(const std::string& name, const std::string& reason) {
    lines += fmt::format("{}: LOST: {}\n", name, reason);
    lost.push_back(fmt::format("{} ({})", name, reason));
  }

  void add_change(const Value& before, const Value& after) {
    const double from = *before.value, to = *after.value, infinite = HUGE_VAL,
                 ratio = from > 0 ? to / from
                         : to > 0 ? infinite
                                  : 1;
    const bool known = before.mad && after.mad;
    const double spread =
        known ? kSignificantDeviations * kDeviationPerMad * std::hypot(*before.mad, *after.mad) : 0;
    const bool changed = std::abs(to - from) > std::max(spread, kMinRelativeChange * from);
    const char* verdict = !known      ? "spread unknown"
                          : !changed  ? "within the spread"
                          : ratio > 1 ? "HIGHER"
                                      : "lower";
    lines += fmt::format("{:<{}} {:>22} {:>22} {:>8.3f} {}\n", after.name, width,
                         with_spread(before), with_spread(after), ratio, verdict);
    ++compared;
    if (ratio > limit && (changed || !known))
      slower.push_back(fmt::format("{} ({:.3f})", after.name, ratio));
  }

  /// Throws Error(validation) if no row has a value in both reports. With a limit also names the
  /// lost rows, and those whose ratio exceeds it, beyond the spread or with unknown spread.
  void require_ratios() const {
    std::vector<std::string> problems;
    if (limit > 0 && !slower.empty())
      problems.push_back(
          fmt::format("{} of {} rows have more than {} times their earlier value: {}",
                      slower.size(), compared, limit, fmt::join(slower, ", ")));
    if (limit > 0 && !lost.empty())
      problems.push_back(
          fmt::format("{} rows have lost their value: {}", lost.size(), fmt::join(lost, ", ")));
    if (compared == 0)
      problems.push_back("no row has a value in both reports; allowed: one or more");
    if (!problems.empty()) throw Error(ExitCode::validation, "{}", fmt::join(problems, "; "));
  }
};

}  // namespace reports

void compare_reports(const std::string& after_file, const std::string& before_file, double limit) {
  using namespace reports;
  const nlohmann::json before = read_json(before_file), after = read_json(after_file);
  const Kind &kind = kind_of(before, before_file), &after_kind = kind_of(after, after_file);
  if (&kind != &after_kind)
    throw Error(ExitCode::bad_input, "{} is of {}, {} of {}; allowed: two reports of one command",
                before_file, kind.command, after_file, after_kind.command);
  if (before.contains("view") && after.contains("view") && before["view"] != after["view"])
    throw Error(ExitCode::bad_input, "{} is of view {}, {} of {}; allowed: reports of one view",
                before_file, before["view"].dump(), after_file, after["view"].dump());
  std::map<std::string, Value> old_values;
  for (Value& value : values_of(kind, before, before_file)) old_values[value.name] = value;
  const std::vector<Value> new_values = values_of(kind, after, after_file);
  Comparer comparer{limit};
  for (const Value& value : new_values)
    comparer.width = std::max(comparer.width, value.name.size());
  for (const Value& value : new_values) {
    const auto old_value = old_values.extract(value.name);
    comparer.add(old_value ? &old_value.mapped() : nullptr, &value);
  }
  for (const auto& [name, value] : old_values) comparer.add(&value, nullptr);
  print_text(fmt::format("{:<{}} {:>22} {:>22} {:>8}\n", "row", comparer.width, "before", "after",
                         "ratio") +
             comparer.lines);
  comparer.require_ratios();
}

}  // namespace clpv
