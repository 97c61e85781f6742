// SPDX-License-Identifier: MIT
// A small schema for untrusted JSON: kind and range of the value at each place.
//
// A document is checked once before it is read, so readers need no checks. Every error names the
// file, the JSON pointer, the value found and the values allowed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

namespace bounds {

// Real glTF nests about 10 levels deep. Parsers may recurse.
inline constexpr int kJsonNesting = 64;
inline constexpr std::uint64_t kJsonBytes = 256ull << 20;  // base64 buffers included
inline constexpr std::uint64_t kJsonValues = 8ull << 20;   // a parsed value takes 16 to 100 bytes

}  // namespace bounds

enum class Shape { object, list, text, flag, integer, number, vector, index };

/// Constraint on the values at a place. Built by the functions in namespace rule.
struct Rule {
  std::string place;  ///< JSON pointer; a segment "*" matches every element or member
  Shape shape;
  double minimum = 0, maximum = 0;  ///< range of a number or vector component; of a list's length
  std::size_t size = 0;             ///< length of a vector
  std::vector<std::int64_t> choices = {};  ///< allowed integers, if not empty
  std::vector<std::string> words = {};     ///< allowed strings, if not empty
  std::string into = {};                   ///< place of the list that an index points into
  bool required = false;                   ///< if the parent exists
  bool nullable = false;                   ///< null is allowed too

  Rule must() && {
    required = true;
    return std::move(*this);
  }
  Rule or_null() && {
    nullable = true;
    return std::move(*this);
  }
};

namespace rule {
inline Rule object(std::string place) {
  return {std::move(place), Shape::object};
}
inline Rule list(std::string place, std::size_t minimum, std::size_t maximum) {
  return {std::move(place), Shape::list, double(minimum), double(maximum)};
}
inline Rule text(std::string place, std::vector<std::string> words = {}) {
  return {.place = std::move(place), .shape = Shape::text, .words = std::move(words)};
}
inline Rule flag(std::string place) {
  return {std::move(place), Shape::flag};
}
inline Rule integer(std::string place, double minimum, double maximum) {
  return {std::move(place), Shape::integer, minimum, maximum};
}
inline Rule choice(std::string place, std::vector<std::int64_t> choices) {
  return {.place = std::move(place), .shape = Shape::integer, .choices = std::move(choices)};
}
inline Rule number(std::string place, double minimum, double maximum) {
  return {std::move(place), Shape::number, minimum, maximum};
}
inline Rule vector(std::string place, std::size_t size, double minimum, double maximum) {
  return {std::move(place), Shape::vector, minimum, maximum, size};
}
inline Rule index(std::string place, std::string into) {
  return {.place = std::move(place), .shape = Shape::index, .into = std::move(into)};
}
}  // namespace rule

/// Throws Error(bad_input) at the first value that violates a rule. Values without a rule are
/// ignored.
void check_rules(const nlohmann::json& document, std::span<const Rule> rules,
                 const std::string& file);

/// Throws Error(bad_input) at the first member without a rule, and lists the allowed keys.
void check_no_other_keys(const nlohmann::json& document, std::span<const Rule> rules,
                         const std::string& file);

/// Parses JSON after bounding its length, nesting and number of values. Throws Error(bad_input)
/// with line and column of a syntax error, or the duplicate key of an object.
nlohmann::json parse_json(std::string_view text, const std::string& file);

/// Reads JSON from a file. Throws Error(bad_input) if it is unreadable, longer than `limit` bytes
/// or invalid.
nlohmann::json read_json(const std::filesystem::path& path,
                         std::uint64_t limit = bounds::kJsonBytes);

/// Returns a value as errors quote it: at most 60 characters of JSON, or the length of an array.
std::string quoted(const nlohmann::json& value);

/// Appends a key to a JSON pointer; escapes '~' and '/'.
std::string pointer_to(const std::string& parent, const std::string& key);

}  // namespace clpv
