// SPDX-License-Identifier: MIT
#include "support/error.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "support/named_enum.hpp"
#include "support/text.hpp"

// Checks of numbers, everywhere, need NaN and infinity.
#if defined(__FAST_MATH__) || __FINITE_MATH_ONLY__
#error "clpv: found -ffast-math, -Ofast or -ffinite-math-only, allowed: none of them"
#endif

namespace clpv {

// Every message passes here. Many quote names and keys of untrusted files, hence printable().
Error::Error(ExitCode code, const std::string& message)
    : std::runtime_error(printable(message)), code_(code) {}

void reject(const std::string& file, std::string_view place, std::string_view found,
            std::string_view allowed) {
  throw Error(ExitCode::bad_input, "{}: {}{}found {}; allowed: {}", file, place,
              place.empty() ? "" : ": ", found, allowed);
}

}  // namespace clpv
namespace clpv {

std::size_t index_of_name(std::string_view what, std::string_view name,
                          std::span<const std::string_view> allowed) {
  const auto found = std::ranges::find(allowed, name);
  if (found == allowed.end())
    throw Error(ExitCode::usage, "{}: found '{}', allowed: {}", what, name,
                fmt::join(allowed, "|"));
  return found - allowed.begin();
}

}  // namespace clpv
