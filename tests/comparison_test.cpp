// SPDX-License-Identifier: MIT
// The one comparison of results with their twins.
#include "checks/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace clpv::reference {
namespace {

TEST(Comparison, TellsTheWorstAndItsPlace) {
  std::vector<double> twin(2 * 8, 0.5);
  std::vector<float> found(twin.begin(), twin.end());
  EXPECT_EQ(compare_volumes(found, twin, 2).worst, 0);
  EXPECT_EQ(compare_volumes(found, twin, 2).place, "");
  found[3] = 0.625f;
  found[8 + 6] = 0.25f;
  EXPECT_EQ(compare_volumes(found, twin, 2).worst, 0.5);
  EXPECT_EQ(compare_volumes(found, twin, 2).place, "cell 0,1,1 plane 1: 0.25, twin 0.5");
}

TEST(Comparison, NaNIsWorseThanAnyNumberAndStays) {
  std::vector<double> twin(8, 0.5);
  std::vector<float> found(twin.begin(), twin.end());
  found[2] = NAN;
  found[5] = 1000;
  EXPECT_TRUE(std::isnan(compare_volumes(found, twin, 2).worst));
  EXPECT_THAT(compare_volumes(found, twin, 2).place, ::testing::HasSubstr("cell 0,1,0"));
}

TEST(Comparison, ATwinOfNothingAllowsNothing) {
  const std::vector<double> twin(8, 0.0);
  std::vector<float> found(8, 0.0f);
  EXPECT_FALSE(compare_volumes(found, twin, 2).worst <= 1);  // 0 / 0 tells nothing: it does not pass
}

}  // namespace
}  // namespace clpv::reference
