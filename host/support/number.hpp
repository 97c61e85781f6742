// SPDX-License-Identifier: MIT
// Numbers in text.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace clpv {

/// The number that the whole of `text` is; nothing where it is none, or none that T holds. "inf" and "nan" are numbers.
template <typename T>
std::optional<T> parse_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace clpv
