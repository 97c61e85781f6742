// SPDX-License-Identifier: MIT
// Exception thrown by all functions of the library.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace clpv {

/// Kind of failure; also the exit codes of the program (`clpv --help`).
enum class ExitCode {
  ok = 0,
  run_time = 1,    ///< out of memory, unwritable output
  usage = 2,       ///< unknown option, value out of range
  bad_input = 3,   ///< invalid scene or image file
  device = 4,      ///< no device, or one without a required capability
  validation = 5,  ///< a result differs from its reference beyond the tolerance
};

/// Failure with a message for the user: file, place, value found and value allowed, or what to do.
class Error : public std::runtime_error {
 public:
  /// Replaces control characters of the message by '?', except newline and tab.
  Error(ExitCode code, const std::string& message);

  template <typename... Args>
  Error(ExitCode code, fmt::format_string<Args...> format, Args&&... args)
      : Error(code, fmt::format(format, std::forward<Args>(args)...)) {}

  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace clpv
