// SPDX-License-Identifier: MIT
// Enumerations whose values have names: the one place where text becomes such a value, and a value text.
//
// An enumeration counts from 0 without gaps and has beside it
//   constexpr std::string_view name_of(E value)
// as a switch without default, so that the compiler tells of a value without a name; {} after it, for what is none.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "support/error.hpp"

namespace clpv {

template <typename E>
concept NamedEnum = std::is_enum_v<E> && requires(E value) {
  { name_of(value) } -> std::same_as<std::string_view>;
};

/// All values, in their order.
template <NamedEnum E>
constexpr auto values_of() {
  constexpr std::size_t count = [] {
    std::size_t n = 0;
    while (!name_of(static_cast<E>(n)).empty()) ++n;
    return n;
  }();
  std::array<E, count> values{};
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<E>(i);
  return values;
}

/// Their names, in the same order.
template <NamedEnum E>
std::vector<std::string> names_of() {
  std::vector<std::string> names;
  for (const E value : values_of<E>()) names.emplace_back(name_of(value));
  return names;
}

/// The value of that name. Throws Error(usage) for another: "layout: found 'planes', allowed: image|aos|soa|tiled".
template <NamedEnum E>
E named(std::string_view what, std::string_view name) {
  for (const E value : values_of<E>()) {
    if (name_of(value) == name) return value;
  }
  throw Error(ExitCode::usage, "{}: found '{}', allowed: {}", what, name, fmt::join(names_of<E>(), "|"));
}

}  // namespace clpv
