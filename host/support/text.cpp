// SPDX-License-Identifier: MIT
#include "support/text.hpp"

#include <algorithm>
#include <cmath>

#include "support/error.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

/// Bytes of the UTF-8 character that `text` begins with; 0 if its first byte begins none.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t bytes = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  // 0xc0, 0xc1 and 0xf5 on begin no character; 0xe0 and 0xf0 have longer forms of shorter ones.
  if (byte(0) < 0xc2 || byte(0) > 0xf4 || bytes > text.size()) return 0;
  if ((byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xf0 && byte(1) < 0x90)) return 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  return bytes;
}

/// True for U+007F to U+009F.
bool is_control(std::string_view character) {
  if (character.size() == 1) return character[0] == 0x7f;
  return character.size() == 2 && character[0] == '\xc2' &&
         static_cast<unsigned char>(character[1]) < 0xa0;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    const auto first = static_cast<unsigned char>(text[0]);
    if (bytes == 0 || is_control(text.substr(0, bytes)) ||
        (first < 0x20 && first != '\n' && first != '\t'))
      out += '?';
    else
      out += text.substr(0, bytes);
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return out;
}

std::string terminal_json(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  while (!json.empty()) {
    const std::size_t bytes = std::max<std::size_t>(character_bytes(json), 1);
    const std::string_view character = json.substr(0, bytes);
    if (is_control(character))
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(character.back()));
    else
      out += character;
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
