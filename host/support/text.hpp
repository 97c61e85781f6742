// SPDX-License-Identifier: MIT
// Conversions between numbers and text, and sanitising of untrusted text.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace clpv {

/// Returns `text` (UTF-8) with control characters (U+0000 to U+001F, U+007F to U+009F) replaced by
/// '?', except newline and tab. Untrusted text must not control a terminal.
std::string printable(std::string_view text);

/// Returns printable() text, escaped for an XML element or attribute.
std::string xml_escaped(const std::string& text);

/// Returns the part of a file name that stands for an untrusted name. It has 1 to 73 ASCII letters,
/// digits, '-' and '_'. A name of 1 to 64 of them is its own part; of others, each other byte is
/// '_', bytes after the 64th go, and '-' with 8 hexadecimal digits of a hash tells them apart.
std::string in_file_name(std::string_view name);

/// Returns the stem "SCENE-CAMERA" of the files of a view.
std::string view_file_name(std::string_view scene, std::string_view camera);

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
