// SPDX-License-Identifier: MIT
// Kernels against the CPU reference, stage by stage, as `clpv check` compares them.
#include "verify/check.hpp"

#include <gtest/gtest.h>

#include "tests/support/on_device.hpp"

namespace clpv::check_test {
namespace {

class Kernels : public ::testing::TestWithParam<Stage> {};

INSTANTIATE_TEST_SUITE_P(Check, Kernels, ::testing::ValuesIn(values_of<Stage>()),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST_P(Kernels, AgreeWithTheReference) {
  const verify::CheckResults results = verify::check(GetParam(), test::test_session());
  EXPECT_FALSE(results.empty());
  for (const verify::CheckResult& result : results) {
    const verify::Deviation& found = result.deviation;
    EXPECT_TRUE(result.passed()) << result.stage << " " << result.variant << ": " << found.worst << ", allowed "
                                 << found.allowed << "; " << found.place << result.reason;
  }
}

}  // namespace
}  // namespace clpv::check_test
