// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace clpv {

/// Returns the file that set_helper_program() set; empty without one.
const std::string& this_program();

}  // namespace clpv
