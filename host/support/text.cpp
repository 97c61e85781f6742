// SPDX-License-Identifier: MIT
#include "support/text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>

#include "support/error.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  ///< 0: invalid
};

/// The first character of a text in UTF-8 (RFC 3629): neither overlong, nor a surrogate, nor above
/// U+10FFFF.
Character first_character(std::string_view text) {
  constexpr std::uint32_t kLowest[] = {0, 0, 0x80, 0x800, 0x10000};  // by length
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 0;
  if (bytes == 0 || lead >= 0xf8 || bytes > text.size()) return {};
  std::uint32_t code = lead & (0x7f >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3f);
  }
  const bool valid =
      code >= kLowest[bytes] && code <= 0x10ffff && !(code >= 0xd800 && code < 0xe000);
  return valid ? Character{code, bytes} : Character{};
}

bool is_control(std::uint32_t code) {
  return (code < 0x20 && code != '\n' && code != '\t') || (code >= 0x7f && code < 0xa0);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Character next = first_character(text);
    const std::size_t bytes = std::max<std::size_t>(next.bytes, 1);
    if (next.bytes == 0 || is_control(next.code))
      out += '?';
    else
      out += text.substr(0, bytes);
    text.remove_prefix(bytes);
  }
  return out;
}

std::string terminal_json(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  while (!json.empty()) {
    const Character next = first_character(json);
    const std::size_t bytes = std::max<std::size_t>(next.bytes, 1);
    if (next.bytes != 0 && next.code >= 0x7f && is_control(next.code))
      out += fmt::format("\\u{:04x}", next.code);
    else
      out += json.substr(0, bytes);
    json.remove_prefix(bytes);
  }
  return out;
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : printable(text)) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else
      out.push_back(c);
  }
  return out;
}

std::string in_file_name(std::string_view name) {
  constexpr std::size_t kMaxLength = 64;
  std::string part(name.empty() ? "_" : name.substr(0, kMaxLength));
  for (char& c : part) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!letter && !(c >= '0' && c <= '9') && c != '-') c = '_';
  }
  if (part == name) return part;
  return fmt::format("{}-{:08x}", part, Fingerprint().add(name).value() & 0xffffffff);
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string view_file_name(std::string_view scene, std::string_view camera) {
  return fmt::format("{}-{}", in_file_name(scene), in_file_name(camera));
}

std::string float_literal(double value) {
  const auto single = static_cast<float>(value);
  if (!std::isfinite(single)) throw Error(ExitCode::run_time, "no kernel literal for {}", value);
  std::string text = fmt::format("{:.9g}", single);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return std::signbit(single) ? "(" + text + "f)" : text + "f";
}

}  // namespace clpv
