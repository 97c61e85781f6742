// SPDX-License-Identifier: MIT
// Which variants a quality run compares: every combination of the values of some render options.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace clpv {

/// One option that varies, and its values.
struct VariedOption {
  std::string name;
  std::vector<std::string> values;
};

/// From "OPTION=a,b,c". Throws Error(usage) where the form, the option or a value is wrong, or a value comes twice.
VariedOption parse_varied(const std::string& text);

/// Values of the varied options, by name, in the order they were given.
using Variant = std::vector<std::pair<std::string, std::string>>;

/// Every combination, the last option varying fastest; one empty variant where nothing varies.
/// Throws Error(usage) where an option comes twice.
std::vector<Variant> combinations(const std::vector<VariedOption>& varied);

/// "basis=sh2 transport=exact"
std::string describe(const Variant& variant);

}  // namespace clpv
