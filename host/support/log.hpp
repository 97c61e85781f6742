// SPDX-License-Identifier: MIT
// Talk: stderr, through spdlog. stdout is for data.
#pragma once

#include <spdlog/spdlog.h>

namespace clpv {

/// quiet: errors only; 0: what a user should know; 1: choices made; 2: everything.
void set_log_level(bool quiet, int verbosity);

}  // namespace clpv
