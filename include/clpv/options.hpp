// SPDX-License-Identifier: MIT
// Options of a rendered frame by name, with the values and defaults of `clpv render`.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// Name, help, range and value of one option.
struct OptionDescription {
  std::string name;     ///< "cascade-size"
  std::string help;     ///< one line, with the unit
  std::string allowed;  ///< "on|off", "1..512"
  std::string value;    ///< default, or the value given
};

/// Options set by the user. Their order does not matter: single options override a preset. An
/// option that is not set has the scene's value (number and size of cascades), else its default.
class Options {
 public:
  /// Sets one option. Throws Error(usage) for an unknown name or a value that is not allowed.
  Options& set(std::string_view name, std::string_view value);

  /// The options set so far, by name.
  const std::map<std::string, std::string>& given() const { return given_; }

  /// Returns all options with their defaults, in the order of --help.
  static std::vector<OptionDescription> all();

 private:
  std::map<std::string, std::string> given_;
};

}  // namespace clpv
