// SPDX-License-Identifier: MIT
// Suites that time clpv beside the same work by other means.
#pragma once

#include "bench/suites.hpp"

namespace clpv::bench {

/// Propagation of sh2 beside C++ with OpenMP and AVX2.
Suite native_suite();

}  // namespace clpv::bench
