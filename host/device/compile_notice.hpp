// SPDX-License-Identifier: MIT
// Says in the log what a long wait for a device's compiler is for.
#pragma once

#include <string>

namespace clpv {

/// Says so (info) as the time spent compiling grows from `before_ms` to `ms` and thereby past a second: once, then.
void tell_of_compiling(const std::string& device, double before_ms, double ms);

/// The programs that took `ms` are about to be kept: says so if that was long, as some drivers compile once more for it.
void tell_of_keeping(double ms);

}  // namespace clpv
