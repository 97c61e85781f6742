// SPDX-License-Identifier: MIT
#include "support/printable.hpp"

namespace clpv {

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    const bool wide = byte == 0xc2 && next >= 0x80 && next < 0xa0;  // U+0080 to U+009F, of two bytes
    if (wide || byte == 0x7f || (byte < 0x20 && byte != '\n' && byte != '\t'))
      out += '?';
    else
      out += text[i];
    if (wide) ++i;
  }
  return out;
}

}  // namespace clpv
