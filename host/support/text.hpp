// SPDX-License-Identifier: MIT
// Conversions between numbers and text, and sanitising of untrusted text.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// Returns `text` with control characters (U+0000 to U+001F, U+007F to U+009F), except newline and
/// tab, and bytes that are not UTF-8 replaced by '?'. Untrusted text must not control a terminal.
std::string printable(std::string_view text);

/// Returns JSON with U+007F to U+009F escaped, which JSON allows in strings and a terminal obeys.
std::string terminal_json(std::string_view json);

/// Returns printable() text, escaped for an XML element or attribute.
std::string xml_escaped(const std::string& text);

/// Returns the part of a file name that stands for an untrusted name. It has 1 to 73 ASCII letters,
/// digits, '-' and '_'. A name of 1 to 64 of them is its own part; of others, each other byte is
/// '_', bytes after the 64th go, and '-' with 8 hexadecimal digits of a hash tells them apart.
std::string in_file_name(std::string_view name);

/// Returns the extension of a file in lower case: ".exr" of "A.EXR".
std::string lower_extension(const std::filesystem::path& path);

/// Returns the stem "SCENE-CAMERA" of the files of a view.
std::string view_file_name(std::string_view scene, std::string_view camera);

/// Returns an OpenCL C float literal that reads back as float(value): "0.25f", "1e-05f", "(-0.5f)".
/// Throws Error(run_time) if float(value) is not finite.
std::string float_literal(double value);

/// Returns `text` without blanks at both ends.
std::string_view trimmed(std::string_view text);

/// Parses all of `text` as a finite decimal number, such as "-2", "+1.5", ".5" or "1e-3"; returns
/// nothing if it is none or out of range. All numbers in text are read by it, but those of JSON.
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(static_cast<double>(value)) ? std::optional(value) : std::nullopt;
}

/// Parses `text` as `Count` numbers between commas, with blanks around them, each as parse_number()
/// does; returns nothing if it is not these.
template <typename Number, std::size_t Count>
std::optional<std::array<Number, Count>> parse_numbers(std::string_view text) {
  std::array<Number, Count> numbers{};
  for (std::size_t i = 0; i < Count; ++i) {
    const std::size_t end = i + 1 < Count ? text.find(',') : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = parse_number<Number>(trimmed(text.substr(0, end)));
    if (!number) return std::nullopt;
    numbers[i] = *number;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return numbers;
}

}  // namespace clpv
