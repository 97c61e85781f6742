// SPDX-License-Identifier: MIT
#pragma once

#include "cli/commands.hpp"

namespace clpv {

/// The lab's additions to the program.
Additions lab_additions();

}  // namespace clpv
