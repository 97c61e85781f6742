// SPDX-License-Identifier: MIT
// Writes comparisons as test cases in JUnit XML, which build servers read.
#pragma once

#include <string>

#include "verify/check.hpp"

namespace clpv::reference {

/// Writes one <testsuite> per stage, in order, and one <testcase> per comparison; failures report error and place.
std::string junit(const CheckResults& results, const std::string& device);

}  // namespace clpv::reference
