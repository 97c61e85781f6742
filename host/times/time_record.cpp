// SPDX-License-Identifier: MIT
#include "times/time_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace clpv {
namespace {

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return std::lerp(sorted[low], sorted[high], at - static_cast<double>(low));
}

}  // namespace

Statistics statistics_of(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::ranges::sort(samples);
  Statistics result{samples.front(), quantile(samples, 0.5), quantile(samples, 0.95),
                    samples.back()};
  for (double& sample : samples) sample = std::abs(sample - result.median);
  std::ranges::sort(samples);
  result.mad = quantile(samples, 0.5);
  return result;
}

double ms_of(const std::vector<TimeRecord>& times, std::string_view stage) {
  double ms = 0;
  for (const TimeRecord& time : times) ms += time.stage == stage ? time.median : 0;
  return ms;
}

TimeRecord time_record(std::string stage, std::vector<double> samples_ms) {
  const std::size_t n = samples_ms.size();
  const Statistics found = statistics_of(std::move(samples_ms));
  return {std::move(stage), {}, {}, n, found.min, found.median, found.mad, found.max};
}

TimeRecord time_record(const StageMark& mark, std::vector<double> samples_ms) {
  TimeRecord record = time_record(std::string(name_of(mark.pass)), std::move(samples_ms));
  record.cascade = mark.cascade, record.light = mark.light;
  return record;
}

std::vector<Rule> time_rules(const std::string& place) {
  constexpr double kMax = std::numeric_limits<double>::max(), kMaxIndex = 1 << 20;
  std::vector<Rule> rules = {rule::object(place), rule::text(place + "/stage").must(),
                             rule::integer(place + "/n", 0, kMax).must()};
  for (const char* index : {"/cascade", "/light"})
    rules.push_back(rule::integer(place + index, 0, kMaxIndex).must().or_null());
  for (const char* figure : {"/min", "/median", "/mad", "/max"})
    rules.push_back(rule::number(place + figure, 0, kMax).must());
  return rules;
}

std::string name_of(const TimeRecord& record) {
  std::string name = record.stage;
  if (record.cascade) name += fmt::format("/cascade:{}", *record.cascade);
  if (record.light) name += fmt::format("/light:{}", *record.light);
  return name;
}

}  // namespace clpv
