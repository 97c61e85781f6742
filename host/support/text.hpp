// SPDX-License-Identifier: MIT
// Conversions between numbers and text, and sanitising of untrusted text.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace clpv {

/// Returns `text` with control characters (U+0000 to U+001F, U+007F to U+009F), except newline and
/// tab, and bytes that are not UTF-8 replaced by '?'. Untrusted text must not control a terminal.
std::string printable(std::string_view text);

/// Returns printable() text, escaped for an XML element or attribute.
std::string xml_escaped(const std::string& text);

/// Returns an OpenCL C float literal that reads back as float(value): "0.25f", "1e-05f", "(-0.5f)".
/// Throws Error(run_time) if float(value) is not finite.
std::string float_literal(double value);

/// Parses all of `text` as a number; returns nothing if it is none or out of range.
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value)
                                                                  : std::nullopt;
}

}  // namespace clpv
