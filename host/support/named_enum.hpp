// SPDX-License-Identifier: MIT
// Enumerations whose values have names: the one place where text becomes such a value, and a value text.
//
// An enumeration counts from 0 without gaps and has beside it its names in their order:
//   template <>
//   inline constexpr auto kNames<Layout> = name_list("image", "aos", "soa", "tiled");
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace clpv {

template <typename E>
inline constexpr std::array<std::string_view, 0> kNames{};

template <typename... Names>
constexpr auto name_list(const Names&... names) {
  return std::array<std::string_view, sizeof...(Names)>{names...};
}

template <typename E>
concept NamedEnum = std::is_enum_v<E> &&(kNames<E>.size() > 0);

/// Empty for what is no value.
template <NamedEnum E>
constexpr std::string_view name_of(E value) {
  const auto i = static_cast<std::size_t>(value);
  return i < kNames<E>.size() ? kNames<E>[i] : std::string_view{};
}

/// All values, in their order.
template <NamedEnum E>
constexpr auto values_of() {
  std::array<E, kNames<E>.size()> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<E>(i);
  return values;
}

/// Their names, in the same order.
template <NamedEnum E>
std::vector<std::string> names_of() {
  return {kNames<E>.begin(), kNames<E>.end()};
}

/// The place of a name in a list. Throws Error(usage) where it is not there: "layout: found 'planes', allowed:
/// image|aos|soa|tiled".
std::size_t place_of_name(std::string_view what, std::string_view name,
                          std::span<const std::string_view> allowed);

/// The value of that name; throws as place_of_name().
template <NamedEnum E>
E named(std::string_view what, std::string_view name) {
  return static_cast<E>(place_of_name(what, name, kNames<E>));
}

}  // namespace clpv
