// SPDX-License-Identifier: MIT
// Error, the exception type of the public interface, and reject() for invalid input.
#pragma once

#include <string>
#include <string_view>

#include "clpv/error.hpp"

namespace clpv {

/// Throws Error(bad_input) "FILE: PLACE: found FOUND; allowed: ALLOWED". `place` is a JSON pointer,
/// or empty.
[[noreturn]] void reject(const std::string& file, std::string_view place, std::string_view found,
                         std::string_view allowed);

}  // namespace clpv
