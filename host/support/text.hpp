// SPDX-License-Identifier: MIT
// Text from numbers and numbers from text; and text of strangers as it may be shown.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace clpv {

/// `text` (UTF-8) without what moves a terminal's cursor, or more: control characters, U+0000 to U+009F, become '?', but for
/// newline and tab.
std::string printable(std::string_view text);

/// printable() text for an element or attribute of XML.
std::string xml_escaped(const std::string& text);

/// A float literal of the kernel language that reads back as float(value): "0.25f", "1e-05f", "(-0.5f)".
/// Throws Error(run_time) for a value that a float cannot hold.
std::string float_literal(double value);

/// The number that all of `text` says; nothing where it says none, or one out of range.
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace clpv
