// SPDX-License-Identifier: MIT
#include "tests/support/every_basis.hpp"

namespace clpv::test {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryBasis);  // in builds of some tests alone
INSTANTIATE_TEST_SUITE_P(Names, EveryBasis, ::testing::ValuesIn(smooth_bases()),
                         [](const auto& info) { return info.param; });

}  // namespace clpv::test
