// SPDX-License-Identifier: MIT
#include "support/xml.hpp"

#include "support/printable.hpp"

namespace clpv {

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

}  // namespace clpv
