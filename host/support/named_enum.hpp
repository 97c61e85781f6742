// SPDX-License-Identifier: MIT
// Conversion between enumeration values and their names.
//
// A named enumeration counts from 0 without gaps; its names follow it in the same order:
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

/// Returns the name of `value`; empty if out of range.
template <NamedEnum E>
constexpr std::string_view name_of(E value) {
  const auto i = static_cast<std::size_t>(value);
  return i < kNames<E>.size() ? kNames<E>[i] : std::string_view{};
}

/// Returns all values in order.
template <NamedEnum E>
constexpr auto values_of() {
  std::array<E, kNames<E>.size()> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<E>(i);
  return values;
}

/// Returns all names in order.
template <NamedEnum E>
std::vector<std::string> names_of() {
  return {kNames<E>.begin(), kNames<E>.end()};
}

/// Returns the index of `name` in `allowed`. Throws Error(usage) if it is missing: "layout: found
/// 'planes', allowed: image|aos|soa|tiled".
std::size_t index_of_name(std::string_view what, std::string_view name,
                          std::span<const std::string_view> allowed);

/// Returns the value named `name`. Throws like index_of_name().
template <NamedEnum E>
E named(std::string_view what, std::string_view name) {
  return static_cast<E>(index_of_name(what, name, kNames<E>));
}

}  // namespace clpv
