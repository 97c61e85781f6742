// SPDX-License-Identifier: MIT
// Limits that a shell sets on this process (ulimit). Drivers abort where they meet one, so clpv
// checks them first.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace clpv {

inline constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// Address space that is left for device memory [bytes], beyond what a driver's compiler and
/// threads take. kUnlimited without `ulimit -v`.
std::uint64_t address_space_left();

/// Throws Error(run_time) with the limit and the least allowed if address space (`ulimit -v`), open
/// files (`ulimit -n`), the stack (`ulimit -s`) or the size of files (`ulimit -f`) are too small
/// for an OpenCL driver on the CPU.
void require_limits();

/// Returns "; limits of this process: ..." with those that explain failures of libraries; empty if
/// there are none.
std::string limits_note();

}  // namespace clpv
