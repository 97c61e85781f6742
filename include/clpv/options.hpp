// SPDX-License-Identifier: MIT
// Every choice that shapes a rendered frame, by name: those of `clpv render`, with the same values and defaults.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// What is to be known of one option.
struct OptionDescription {
  std::string name;     ///< "cascade-size"
  std::string help;     ///< with the unit
  std::string allowed;  ///< "on|off", "1..512"
  std::string value;    ///< by default, or as given
};

/// Options given, in any order: a preset comes before those that override it. What is not given is the scene's, where
/// it has a wish (cascades), else the default.
class Options {
 public:
  /// Throws Error(usage) for an unknown name, or for a value that is not allowed: option, value found, values allowed.
  Options& set(std::string_view name, std::string_view value);

  const std::map<std::string, std::string>& given() const { return given_; }

  /// All there are, in the order of --help.
  static std::vector<OptionDescription> all();

 private:
  std::map<std::string, std::string> given_;
};

}  // namespace clpv
