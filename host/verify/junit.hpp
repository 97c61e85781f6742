// SPDX-License-Identifier: MIT
// Comparisons as test cases, in the XML that JUnit began and build servers read.
#pragma once

#include <string>

#include "verify/check.hpp"

namespace clpv::reference {

/// One <testsuite> a stage in the order they come, one <testcase> a comparison; a failed one says by how much and where.
std::string junit(const CheckResults& results, const std::string& device);

}  // namespace clpv::reference
