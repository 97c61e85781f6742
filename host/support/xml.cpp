// SPDX-License-Identifier: MIT
#include "support/xml.hpp"

namespace clpv {

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t')
      out += '?';
    else
      out.push_back(c);
  }
  return out;
}

}  // namespace clpv
