// SPDX-License-Identifier: MIT
// Random values of render options, drawn from the ranges in the option table, for tests and
// fuzzing.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "options/render_options.hpp"
#include "support/text.hpp"

namespace clpv::test {

/// A sequence of choices, from a random generator or from a fuzzer's bytes.
class Choices {
 public:
  /// `below(end)` returns a number from 0 to end - 1.
  explicit Choices(std::function<std::size_t(std::size_t end)> below) : below_(std::move(below)) {}

  bool one_in(std::size_t count) { return below_(count) == 0; }
  template <typename List>
  const auto& of(const List& list) {
    return list[below_(std::size(list))];
  }
  double between(double minimum, double maximum) {
    constexpr std::size_t kSteps = 1 << 16;
    return minimum + (maximum - minimum) * static_cast<double>(below_(kSteps + 1)) / kSteps;
  }
  /// Uniform in the logarithm. Requires minimum > 0.
  double scale_between(double minimum, double maximum) {
    return std::clamp(std::exp(between(std::log(minimum), std::log(maximum))), minimum, maximum);
  }

 private:
  std::function<std::size_t(std::size_t end)> below_;
};

/// Upper bounds of options that only cost time or memory.
using Caps = std::map<std::string, double>;

/// Returns a value that the option table allows: at an end of the range, or inside it; "" for a
/// file.
inline std::string drawn_value(const OptionDescription& option, Choices& choices,
                               const Caps& caps) {
  const std::string& allowed = option.allowed;
  if (allowed.find('|') != std::string::npos) {
    std::vector<std::string> names;
    for (std::size_t from = 0, to; from <= allowed.size(); from = to + 1) {
      to = std::min(allowed.find('|', from), allowed.size());
      names.push_back(allowed.substr(from, to - from));
    }
    return choices.of(names);
  }
  constexpr std::string_view kAbove = "greater than ", kBelow = " and less than ";
  constexpr double kInside = 1e-3;  // from the ends of an open range
  const bool open = allowed.starts_with(kAbove);
  const std::string_view between = open ? kBelow : std::string_view("..");
  const std::size_t start = open ? kAbove.size() : 0, middle = allowed.find(between);
  if (middle == std::string::npos) return {};
  const auto minimum =
                 parse_number<double>(std::string_view(allowed).substr(start, middle - start)),
             maximum =
                 parse_number<double>(std::string_view(allowed).substr(middle + between.size()));
  if (!minimum || !maximum) return {};
  const double first = *minimum + (open ? kInside : 0), end = *maximum - (open ? kInside : 0);
  const auto cap = caps.find(option.name);
  const double last = cap == caps.end() ? end : std::min(end, cap->second);
  double value = choices.one_in(8)   ? first
                 : choices.one_in(8) ? last
                 : first > 0         ? choices.scale_between(first, last)
                                     : choices.between(first, last);
  if (option.value.find('.') == std::string::npos)
    value = std::round(value);  // a whole number, like its default
  return fmt::format("{}", value);
}

}  // namespace clpv::test
