// SPDX-License-Identifier: MIT
// Variables of the environment during a test.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace clpv::test {

/// A variable with another value, or none; restored at the end.
class Variable {
 public:
  explicit Variable(const char* name) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
  }
  Variable(const char* name, const std::optional<std::string>& value) : Variable(name) {
    set(value);
  }
  Variable(const Variable&) = delete;
  ~Variable() { set(before_); }

  void set(const std::optional<std::string>& value) const {
    value ? ::setenv(name_, value->c_str(), 1) : ::unsetenv(name_);
  }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace clpv::test
