// SPDX-License-Identifier: MIT
// Exception thrown by all functions of the library.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>

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

  ExitCode code() const { return code_; }

 private:
  template <typename... Args>
  struct Format;

 public:
  /// Formats the message. Only the library's own code can use it (host/support/error.hpp).
  template <typename First, typename... More>
  Error(ExitCode code, Format<std::type_identity_t<First>, std::type_identity_t<More>...> format,
        First&& first, More&&... more);

 private:
  ExitCode code_;
};

}  // namespace clpv
