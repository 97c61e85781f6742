// SPDX-License-Identifier: MIT
#include "evaluate/quality_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "options/render_options.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

VariedOption parse_varied(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) throw Error(ExitCode::usage, "vary {}: allowed: OPTION=a,b,c", text);
  VariedOption varied{text.substr(0, equals), {}};
  for (const std::string& value : split(text.substr(equals + 1), ',')) {
    RenderOptions probe;
    set_option(probe, varied.name, value);  // throws for an unknown option or a bad value
    if (std::ranges::count(varied.values, value) > 0) {
      throw Error(ExitCode::usage, "vary {}: {} comes twice", text, value);
    }
    varied.values.push_back(value);
  }
  return varied;
}

std::vector<Variant> combinations(const std::vector<VariedOption>& varied) {
  std::vector<Variant> all(1);
  for (const VariedOption& option : varied) {
    const auto same = [&](const VariedOption& other) { return other.name == option.name; };
    if (std::ranges::count_if(varied, same) > 1) {
      throw Error(ExitCode::usage, "vary {}: the option comes twice", option.name);
    }
    std::vector<Variant> longer;
    for (const Variant& variant : all) {
      for (const std::string& value : option.values) {
        longer.push_back(variant);
        longer.back().emplace_back(option.name, value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

std::string describe(const Variant& variant) {
  std::string text;
  for (const auto& [name, value] : variant)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
  return text;
}

}  // namespace clpv
