// SPDX-License-Identifier: MIT
// Curves through keys against their closed forms.
#include "scene/curve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace clpv::curve_test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::Pointwise;

constexpr double kExact = 1e-14;  // a few roundings of numbers near 1
constexpr double kPi = glm::pi<double>();

std::vector<double> at(const Curve& curve, double seconds) {
  std::vector<double> value(curve.components);
  evaluate(curve, seconds, value);
  return value;
}

/// x, y, z, w of a turn about an axis.
std::vector<double> turn(const glm::dvec3& axis, double angle) {
  const glm::dvec3 v = axis * std::sin(angle / 2);
  return {v.x, v.y, v.z, std::cos(angle / 2)};
}

std::vector<double> joined(const std::vector<std::vector<double>>& parts) {
  std::vector<double> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(Curve, IsConstantBeforeTheFirstKeyAndAfterTheLast) {
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::step}) {
    const Curve curve{interpolation, 2, {1, 3}, {5, 6, 9, 10}};
    for (const double early : {-1e6, 0.0, 1.0}) EXPECT_THAT(at(curve, early), ElementsAre(5, 6));
    for (const double late : {3.0, 4.0, 1e6}) EXPECT_THAT(at(curve, late), ElementsAre(9, 10));
  }
  const Curve spline{Interpolation::cubic_spline, 1, {1, 3}, {7, 5, 7, 7, 9, 7}};
  EXPECT_THAT(at(spline, 0), ElementsAre(5));
  EXPECT_THAT(at(spline, 9), ElementsAre(9));
}

TEST(Curve, SplineIsTheCubicOfItsValuesAndSlopes) {
  // p(x) = 2x^3 - 3x^2 + x + 5 and its slope 6x^2 - 6x + 1, at uneven keys: every piece is the same
  // cubic.
  const auto p = [](double x) { return ((2 * x - 3) * x + 1) * x + 5; };
  const auto slope = [](double x) { return (6 * x - 6) * x + 1; };
  Curve curve{Interpolation::cubic_spline, 1, {0, 0.5, 2}, {}};
  for (const double x : curve.times)
    curve.values = joined({curve.values, {slope(x), p(x), slope(x)}});
  for (const double x : {0.0, 0.1, 0.25, 0.5, 0.6, 1.0, 1.7, 2.0})
    EXPECT_NEAR(at(curve, x)[0], p(x), 10 * kExact) << x;
}

TEST(Curve, SplineLeavesByOneTangentAndArrivesByTheOther) {
  // Hermite's basis at one half: (1, 1, 1/8, -1/8) of (from / 2, to / 2, span * leaving, span *
  // arriving).
  const Curve curve{Interpolation::cubic_spline, 1, {0, 4}, {100, 1, 2, 3, 5, 100}};
  EXPECT_NEAR(at(curve, 2)[0], 0.5 + 2.5 + 4 * 2.0 / 8 - 4 * 3.0 / 8, kExact);
}

TEST(Curve, RotationsTurnEvenlyAboutTheirAxis) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, -2));
  const Curve curve{Interpolation::linear, 4, {0, 2}, joined({turn(axis, 0.2), turn(axis, 1.4)})};
  for (const double share : {0.0, 0.25, 0.5, 0.9}) {
    const glm::dquat q = rotation_at(curve, 2 * share);
    EXPECT_THAT((std::vector{q.x, q.y, q.z, q.w}),
                Pointwise(DoubleNear(kExact), turn(axis, 0.2 + 1.2 * share)))
        << share;
  }
}

TEST(Curve, RotationsTakeTheShorterWay) {
  // The same rotation with its sign turned: half way from 0 to 90 degrees is 45, not 225.
  std::vector<double> there = turn({0, 0, 1}, kPi / 2);
  for (double& v : there) v = -v;
  const Curve curve{Interpolation::linear, 4, {0, 1}, joined({turn({0, 0, 1}, 0), there})};
  const glm::dvec3 turned = rotation_at(curve, 0.5) * glm::dvec3(1, 0, 0);
  EXPECT_NEAR(turned.x, std::sqrt(0.5), kExact);
  EXPECT_NEAR(turned.y, std::sqrt(0.5), kExact);
}

TEST(Curve, SplinesOfRotationsAreMadeUnit) {
  const std::vector<double> none(4, 0.0);
  const Curve curve{Interpolation::cubic_spline,
                    4,
                    {0, 1},
                    joined({none, turn({0, 1, 0}, 0), none, none, turn({0, 1, 0}, 1), none})};
  const glm::dquat half = rotation_at(curve, 0.5);
  EXPECT_NEAR(glm::length(half), 1, kExact);
  EXPECT_NEAR(half.y, std::sin(0.25), kExact) << "half of two unit quaternions points half way";
}

}  // namespace
}  // namespace clpv::curve_test
