// SPDX-License-Identifier: MIT
#include "commands/parse.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

#include "support/error.hpp"

namespace clpv {
namespace {

template <typename T>
bool parse_three(std::string_view text, T (&out)[3]) {
  for (int i = 0; i < 3; ++i) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out[i]);
    if (error != std::errc{}) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (i == 2) return text.empty();
    if (text.empty() || text.front() != ',') return false;
    text.remove_prefix(1);
  }
  return false;
}

}  // namespace

glm::dvec3 parse_dvec3(const std::string& text, const char* option) {
  double v[3];
  if (!parse_three(text, v) || !std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2])) {
    throw Error(ExitCode::usage, "{}: '{}' is not three finite numbers between commas, like 0,0.5,-1", option,
                text);
  }
  return {v[0], v[1], v[2]};
}

glm::ivec3 parse_ivec3(const std::string& text, const char* option) {
  int v[3];
  if (!parse_three(text, v))
    throw Error(ExitCode::usage, "{}: '{}' is not three integers between commas, like 16,16,16", option,
                text);
  return {v[0], v[1], v[2]};
}

std::pair<glm::ivec3, glm::ivec3> parse_box(const std::string& text, const char* option) {
  const auto colon = text.find(':');
  if (colon == std::string::npos)
    throw Error(ExitCode::usage, "{}: '{}' is not two corners i0,j0,k0:i1,j1,k1", option, text);
  const glm::ivec3 a = parse_ivec3(text.substr(0, colon), option),
                   b = parse_ivec3(text.substr(colon + 1), option);
  if (glm::any(glm::greaterThan(a, b)))
    throw Error(ExitCode::usage, "{}: '{}': the first corner is beyond the second", option, text);
  return {a, b};
}

}  // namespace clpv
