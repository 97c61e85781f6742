// SPDX-License-Identifier: MIT
#include "support/text.hpp"

#include <cmath>

#include "support/error.hpp"

namespace clpv {

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    // U+0080 to U+009F, of two bytes.
    const bool wide = byte == 0xc2 && next >= 0x80 && next < 0xa0;
    if (wide || byte == 0x7f || (byte < 0x20 && byte != '\n' && byte != '\t'))
      out += '?';
    else
      out += text[i];
    if (wide) ++i;
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

std::string float_literal(double value) {
  const auto single = static_cast<float>(value);
  if (!std::isfinite(single)) throw Error(ExitCode::run_time, "no kernel literal for {}", value);
  std::string text = fmt::format("{:.9g}", single);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return std::signbit(single) ? "(" + text + "f)" : text + "f";
}

}  // namespace clpv
