// SPDX-License-Identifier: MIT
// Typed literals (`#define NAME VALUE`) that specialise a kernel's source.
#pragma once

#include <concepts>
#include <map>
#include <string>

namespace clpv {

/// Set of literals. Each name starts with CLPV_ and is defined once. Functions throw
/// Error(run_time) for another name or a second definition.
class Literals {
 public:
  Literals& flag(const std::string& name, bool value);  ///< 1 or 0
  template <std::integral T>
  requires(!std::same_as<T, bool>) Literals& integer(const std::string& name,
                                                     T value) {  ///< int: "3"
    return define(name, std::to_string(value));
  }
  template <std::integral T>
  requires(!std::same_as<T, bool>) Literals& number(const std::string& name,
                                                    T value) {  ///< uint: "3u"
    return define(name, std::to_string(value) + "u");
  }
  Literals& real(const std::string& name, double value);  ///< float: float_literal()
  Literals& word(const std::string& name,
                 const std::string& word);  ///< name defined in the kernels: "CLPV_SOA"

  const std::map<std::string, std::string>& defined() const { return defined_; }

 private:
  Literals& define(const std::string& name, std::string text);

  std::map<std::string, std::string> defined_;
};

}  // namespace clpv
