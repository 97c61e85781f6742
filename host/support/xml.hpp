// SPDX-License-Identifier: MIT
// Text in XML.
#pragma once

#include <string>

namespace clpv {

/// As an attribute's value or an element's text; control characters, which XML 1.0 has not, become '?'.
std::string xml_escaped(const std::string& text);

}  // namespace clpv
