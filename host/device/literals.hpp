// SPDX-License-Identifier: MIT
// What a kernel's source is specialised with, each literal by its type.
#pragma once

#include <concepts>
#include <map>
#include <string>

namespace clpv {

/// Literals, each written as `#define NAME VALUE`; NAME starts with CLPV_ and is defined once: a second definition, or
/// another name, throws Error(run_time).
class Literals {
 public:
  Literals& flag(const std::string& name, bool value);  ///< 1 or 0
  template <std::integral T>
  requires(!std::same_as<T, bool>) Literals& integer(const std::string& name, T value) {  ///< an int: "3"
    return define(name, std::to_string(value));
  }
  template <std::integral T>
  requires(!std::same_as<T, bool>) Literals& number(const std::string& name, T value) {  ///< a uint: "3u"
    return define(name, std::to_string(value) + "u");
  }
  Literals& real(const std::string& name, double value);  ///< a float: float_literal()
  Literals& word(const std::string& name,
                 const std::string& word);  ///< a name of the kernels' own: "CLPV_SOA"

  const std::map<std::string, std::string>& defined() const { return defined_; }

 private:
  Literals& define(const std::string& name, std::string text);

  std::map<std::string, std::string> defined_;
};

}  // namespace clpv
