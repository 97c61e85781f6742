// SPDX-License-Identifier: MIT
// Logging to stderr through spdlog; stdout carries data only.
#pragma once

#include <spdlog/spdlog.h>

namespace clpv {

/// Sets the log level. quiet: errors only; verbosity 0: info, 1: debug, 2: trace.
void set_log_level(bool quiet, int verbosity);

}  // namespace clpv
