// SPDX-License-Identifier: MIT
#pragma once

#include "cli/additions.hpp"

namespace clpv {

/// What the lab adds to the program.
Additions lab_additions();

}  // namespace clpv
