// SPDX-License-Identifier: MIT
// What strangers' files say, as it may be told.
#pragma once

#include <string>
#include <string_view>

namespace clpv {

/// `text` (UTF-8) without what moves a terminal's cursor, or more: control characters, U+0000 to U+009F, become '?', but for
/// newline and tab.
std::string printable(std::string_view text);

}  // namespace clpv
