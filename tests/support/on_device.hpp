// SPDX-License-Identifier: MIT
// The device that tests run on, and expectations for results of `clpv check`.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "device/session.hpp"
#include "verify/check.hpp"

namespace clpv::test {

/// One session a process: kernels that several tests use are built once.
inline Session& test_session() {
  // Never released: a driver's own statics may be gone before a static session is.
  static Session* const session = new Session(choose_device());
  return *session;
}

/// Every case of a check passed, and there are at least `least` of them.
inline void expect_passed(const reference::CheckResults& results, std::size_t least = 1) {
  EXPECT_GE(results.size(), least);
  for (const reference::CheckResult& result : results) {
    EXPECT_TRUE(result.passed()) << result.stage << " " << result.variant << ": " << result.worst
                                 << ", allowed " << result.allowed << "; " << result.place;
  }
}

}  // namespace clpv::test
