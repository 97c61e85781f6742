// SPDX-License-Identifier: MIT
#include "support/named_enum.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "support/error.hpp"

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
