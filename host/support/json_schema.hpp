// SPDX-License-Identifier: MIT
// A small schema for untrusted JSON: which value stands where, of what kind and in what range.
//
// Checked once, before anything reads the document, so that readers need not check again; every rejection names
// the file, the JSON pointer, the value found and the values allowed.
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

// Text. Real glTF nests some ten levels deep; extras a few more. Parsers downstream may recurse.
inline constexpr int kJsonNesting = 64;
inline constexpr std::uint64_t kJsonBytes = 256ull << 20;  // base64 buffers included
inline constexpr std::uint64_t kJsonValues = 8ull << 20;   // parsed, a value takes 16 to 100 bytes

}  // namespace bounds

enum class Shape { object, list, text, flag, integer, number, vector, index };

/// What may stand at a place. Made by the functions below.
struct Rule {
  std::string place;  ///< JSON pointer; a segment "*" means every element or member
  Shape shape;
  double least = 0, most = 0;              ///< of numbers and of a vector's components; of a list: its length
  std::size_t size = 0;                    ///< of a vector
  std::vector<std::int64_t> choices = {};  ///< an integer is one of these, where there are any
  std::vector<std::string> words = {};     ///< a text is one of these, where there are any
  std::string into = {};                   ///< the list that an index points into
  bool required = false;                   ///< where the parent exists

  Rule must() && {
    required = true;
    return std::move(*this);
  }
};

namespace rule {
Rule object(std::string place);
Rule list(std::string place, std::size_t least, std::size_t most);
Rule text(std::string place, std::vector<std::string> words = {});
Rule flag(std::string place);
Rule integer(std::string place, double least, double most);
Rule choice(std::string place, std::vector<std::int64_t> choices);
Rule number(std::string place, double least, double most);
Rule vector(std::string place, std::size_t size, double least, double most);
Rule index(std::string place, std::string into);
}  // namespace rule

/// Throws Error(bad_input) at the first rule broken. Values that no rule speaks of are not looked at.
void check_rules(const nlohmann::json& document, std::span<const Rule> rules, const std::string& file);

/// Throws Error(bad_input) at the first member that no rule speaks of, and lists those allowed there.
void check_no_other_keys(const nlohmann::json& document, std::span<const Rule> rules,
                         const std::string& file);

/// Parses JSON whose length, nesting and number of values are bounded first. Throws Error(bad_input) with line and column of a syntax
/// error.
nlohmann::json parse_json(std::string_view text, const std::string& file);

/// The JSON of a file of at most `most` bytes. Throws Error(bad_input) where it cannot be read, is longer, or is no JSON.
nlohmann::json read_json(const std::filesystem::path& path, std::uint64_t most = bounds::kJsonBytes);

/// What a message quotes of a value: enough to recognise it.
std::string quoted(const nlohmann::json& value);

/// A JSON pointer one level further down; '~' and '/' of the key escaped.
std::string pointer_to(const std::string& parent, const std::string& key);

}  // namespace clpv
