// SPDX-License-Identifier: MIT
// What is thrown, as an exit code and words.
#pragma once

#include <string>

#include "support/error.hpp"

namespace clpv {

struct Failure {
  ExitCode code = ExitCode::run_time;
  std::string words;
};

/// Of the exception being handled: an Error, OpenCL's, or the library's.
Failure current_failure();

}  // namespace clpv
