// SPDX-License-Identifier: MIT
// The one comparison of results with their twins.
#include "checks/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "basis/basis.hpp"
#include "reference/inject.hpp"

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

TEST(Comparison, OfSurfacesThatBlockAlmostAlikeEitherIsRight) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const std::vector<double> up = basis->clamped_cosine({0, 1, 0}), along = basis->clamped_cosine({1, 0, 0});
  Volume a(2, basis->size(), 1), b = a;
  const auto put = [](Volume& to, int x, const std::vector<double>& c, double scale) {
    for (std::size_t i = 0; i < c.size(); ++i) to.at(0, static_cast<int>(i), x, 0, 0) = scale * c[i];
  };
  put(a, 0, up, 1), put(b, 0, along, 1.0005);  // as halves may round it
  put(a, 1, up, 1), put(b, 1, along, 1.01);
  Volume merged = a;
  merge_geometry(b, *basis, Blocking::one_sided, merged);
  EXPECT_EQ(merged.values, b.values);
  const Volume other = otherwise_merged(a, b, *basis, Blocking::one_sided);
  for (int i = 0; i < basis->size(); ++i) {
    EXPECT_EQ(other.value(0, i, 0, 0, 0), a.value(0, i, 0, 0, 0));
    EXPECT_EQ(other.value(0, i, 1, 0, 0), b.value(0, i, 1, 0, 0));
  }
}

}  // namespace
}  // namespace clpv::reference
