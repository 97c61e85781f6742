// SPDX-License-Identifier: MIT
// A small schema for untrusted JSON: which value stands where, of what kind and in what range.
//
// Checked once, before anything reads the document, so that readers need not check again; every refusal names
// the file, the JSON pointer, the value found and the values allowed.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace clpv {

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

/// A file of JSON, of at most `most` bytes. Throws Error(bad_input) where it cannot be read, is longer, or is no JSON.
nlohmann::json read_json(const std::string& path, std::uintmax_t most);

/// What a message quotes of a value: enough to recognise it.
std::string quoted(const nlohmann::json& value);

/// A JSON pointer one level further down; '~' and '/' of the key escaped.
std::string pointer_to(const std::string& parent, const std::string& key);

}  // namespace clpv
