// SPDX-License-Identifier: MIT
// Error, the exception type of the public interface, with formatted messages; reject() for invalid
// input.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "clpv/error.hpp"

namespace clpv {

/// A format string that the compiler checks.
template <typename... Args>
struct Error::Format {
  template <std::size_t n>
  consteval Format(const char (&literal)[n]) : text(literal) {}
  fmt::format_string<Args...> text;
};

template <typename First, typename... More>
Error::Error(ExitCode code,
             Format<std::type_identity_t<First>, std::type_identity_t<More>...> format,
             First&& first, More&&... more)
    : Error(code,
            fmt::format(format.text, std::forward<First>(first), std::forward<More>(more)...)) {}

/// Throws Error(bad_input) "FILE: PLACE: found FOUND; allowed: ALLOWED". `place` is a JSON pointer,
/// or empty.
[[noreturn]] void reject(const std::string& file, std::string_view place, std::string_view found,
                         std::string_view allowed);

}  // namespace clpv
