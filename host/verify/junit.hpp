// SPDX-License-Identifier: MIT
// Writes comparisons as test cases in JUnit XML, which build servers read.
#pragma once

#include <string>

#include "verify/check.hpp"

namespace clpv::verify {

/// Writes one <testsuite> per stage, in order, and one <testcase> per result. Wrong results are
/// failures with error and place, failed ones errors, unsupported ones skipped. Without a result
/// that is ok, one more test case is an error, since servers take skipped ones for good.
std::string junit(CheckResults results, const std::string& device);

}  // namespace clpv::verify
