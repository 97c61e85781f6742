// SPDX-License-Identifier: MIT
// What a user of the library may catch.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace clpv {

/// What kind of failure it is; the program's exit codes, as documented in `clpv --help`.
enum class ExitCode {
  ok = 0,
  run_time = 1,    ///< out of device memory, unwritable output
  usage = 2,       ///< unknown option, value out of range
  bad_input = 3,   ///< bad scene or image file
  device = 4,      ///< no device, or one that lacks what was asked
  validation = 5,  ///< a computed result differs from its reference
};

/// A failure told in the user's words: file, place, value found, value allowed; or what to do about it.
class Error : public std::runtime_error {
 public:
  /// Control characters of the message, but for newline and tab, become '?'.
  Error(ExitCode code, const std::string& message);

  template <typename... Args>
  Error(ExitCode code, fmt::format_string<Args...> format, Args&&... args)
      : Error(code, fmt::format(format, std::forward<Args>(args)...)) {}

  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace clpv
