// SPDX-License-Identifier: MIT
// Small values on the command line: vectors "x,y,z" and boxes "i0,j0,k0:i1,j1,k1".
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <utility>

namespace clpv {

/// Three numbers between commas. Throw Error(usage) naming the option, the text and what is allowed.
glm::dvec3 parse_dvec3(const std::string& text, const char* option);
glm::ivec3 parse_ivec3(const std::string& text, const char* option);
/// Two corners, the first not beyond the second.
std::pair<glm::ivec3, glm::ivec3> parse_box(const std::string& text, const char* option);

}  // namespace clpv
