// SPDX-License-Identifier: MIT
// One exception type for everything a user can meet: it is part of the library's door.
#pragma once

#include <string>
#include <string_view>

#include "clpv/error.hpp"

namespace clpv {

/// Throws Error(bad_input): "FILE: PLACE: found FOUND; allowed: ALLOWED". PLACE is a JSON pointer or empty.
[[noreturn]] void reject(const std::string& file, std::string_view place, std::string_view found,
                         std::string_view allowed);

}  // namespace clpv
