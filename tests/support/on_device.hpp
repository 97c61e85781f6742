// SPDX-License-Identifier: MIT
// The device that tests run on, and what is expected of the checks there.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "checks/check.hpp"
#include "device/session.hpp"

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

/// What is left of a check once each basis has had a test of its own.
inline reference::CheckScope beyond_bases() {
  return {.bases = {}};
}

/// A test a basis, so that each is short: TEST_P(Name, ...) of a check's part.
class CheckOfBasis : public ::testing::TestWithParam<std::string> {
 protected:
  static reference::CheckScope scope() { return {.bases = {GetParam()}, .beyond_bases = false}; }
};

}  // namespace clpv::test
