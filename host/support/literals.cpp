// SPDX-License-Identifier: MIT
#include "support/literals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

double largest_of(std::span<const double> values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

std::string initialiser(std::span<const double> values, double largest) {
  std::vector<std::string> texts;
  for (const double value : values)
    texts.push_back(float_literal(std::abs(value) <= 1e-12 * largest ? 0 : value));
  return fmt::format("{{{}}}", fmt::join(texts, ", "));
}

}  // namespace

Literals& Literals::flag(const std::string& name, bool value) {
  return define(name, value ? "1" : "0");
}

Literals& Literals::real(const std::string& name, double value) {
  return define(name, float_literal(value));
}

Literals& Literals::word(const std::string& name, const std::string& word) {
  return define(name, word);
}

Literals& Literals::reals(const std::string& name, std::span<const double> values) {
  return define(name, initialiser(values, largest_of(values)));
}

Literals& Literals::integers(const std::string& name, std::span<const int> values) {
  return define(name, fmt::format("{{{}}}", fmt::join(values, ", ")));
}

Literals& Literals::table(const std::string& name,
                          const std::vector<std::span<const double>>& rows) {
  double largest = 0;
  for (const auto& row : rows) largest = std::max(largest, largest_of(row));
  std::vector<std::string> texts;
  for (const auto& row : rows) texts.push_back(initialiser(row, largest));
  return define(name, fmt::format("{{{}}}", fmt::join(texts, ", \\\n  ")));
}

Literals& Literals::add(const Literals& others) {
  for (const auto& [name, text] : others.defined_) define(name, text);
  return *this;
}

Literals& Literals::define(const std::string& name, std::string text) {
  if (!name.starts_with("CLPV_"))
    throw Error(ExitCode::run_time, "kernel literal {}: names start with CLPV_", name);
  const auto [found, made] = defined_.emplace(name, text);
  if (!made)
    throw Error(ExitCode::run_time, "kernel literal {}: {} and {}", name, found->second, text);
  return *this;
}

}  // namespace clpv
