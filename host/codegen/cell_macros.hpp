// SPDX-License-Identifier: MIT
// What the text of every kernel that handles cells starts with.
#pragma once

#include <string>

namespace clpv {

/// Text every kernel that handles coefficients starts with (ProgramSource::generated): CLPV_INLINE, CLPV_LANES and
/// CLPV_REAL, CLPV_N, CLPV_EACH_COEFFICIENT(DO) and the struct Coefficients of N CLPV_REALs c0, c1, ...
std::string coefficient_macros(int coefficients);

/// The struct `type` of `count` CLPV_REALs c0, c1, ... and CLPV_EACH_`each`(DO), which writes DO(0) DO(1) ...
std::string cell_macros(const std::string& type, const std::string& each, int count);

}  // namespace clpv
