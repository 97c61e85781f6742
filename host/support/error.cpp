// SPDX-License-Identifier: MIT
#include "support/error.hpp"

#include "support/printable.hpp"

namespace clpv {

// Here, where all messages pass: many have words of files, names and keys that a stranger chose.
Error::Error(ExitCode code, const std::string& message)
    : std::runtime_error(printable(message)), code_(code) {}

}  // namespace clpv
