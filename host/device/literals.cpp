// SPDX-License-Identifier: MIT
#include "device/literals.hpp"

#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv {

Literals& Literals::flag(const std::string& name, bool value) {
  return define(name, value ? "1" : "0");
}

Literals& Literals::real(const std::string& name, double value) {
  return define(name, float_literal(value));
}

Literals& Literals::word(const std::string& name, const std::string& word) {
  return define(name, word);
}

Literals& Literals::define(const std::string& name, std::string text) {
  if (!name.starts_with("CLPV_"))
    throw Error(ExitCode::run_time, "kernel literal {}: names start with CLPV_", name);
  const auto [found, made] = defined_.emplace(name, text);
  if (!made)
    throw Error(ExitCode::run_time, "kernel literal {}: {} and {}", name, found->second, text);
  return *this;
}

}  // namespace clpv
