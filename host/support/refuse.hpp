// SPDX-License-Identifier: MIT
// Refusing what stands in a file.
#pragma once

#include <string>
#include <string_view>

namespace clpv {

/// Throws Error(bad_input): "FILE: PLACE: found FOUND; allowed: ALLOWED". PLACE is a JSON pointer or empty.
[[noreturn]] void refuse(const std::string& file, std::string_view place, std::string_view found,
                         std::string_view allowed);

}  // namespace clpv
