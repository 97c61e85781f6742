// SPDX-License-Identifier: MIT
// Bases against quadrature done here: Gram matrices, integrals of the clamped cosine, quality of
// its lobe.
#include "basis/basis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "basis/clamped_cosine.hpp"
#include "basis/lobe_quality.hpp"
#include "basis/srbf.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/sphere_quadrature.hpp"

namespace clpv::basis_test {
namespace {

using test::integral;
using test::sphere;

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kUp(0, 0, 1), kOblique = glm::normalize(glm::dvec3(-2, 1, -3));

struct BasisOf : test::EveryBasis {};
INSTANTIATE_TEST_SUITE_P(Names, BasisOf, ::testing::ValuesIn(test::smooth_bases()),
                         [](const auto& info) { return info.param; });

TEST_P(BasisOf, GramMatrixAndIntegralsAreThoseOfItsFunctions) {
  const int n = basis_->size();
  Matrix gram(n, n);
  std::vector<double> integrals(static_cast<std::size_t>(n), 0.0);
  for (const test::Node& node : sphere()) {
    const std::vector<double> b = basis_->evaluate(node.w);
    for (int i = 0; i < n; ++i) {
      integrals[static_cast<std::size_t>(i)] += node.weight * b[static_cast<std::size_t>(i)];
      for (int j = 0; j < n; ++j)
        gram(i, j) += node.weight * b[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)];
    }
  }
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(basis_->integrals()[static_cast<std::size_t>(i)],
                integrals[static_cast<std::size_t>(i)], 1e-11);
    for (int j = 0; j < n; ++j)
      EXPECT_NEAR(basis_->gram()(i, j), gram(i, j), 1e-11) << i << ' ' << j;
  }
}

TEST_P(BasisOf, CosineIntegralsAreThoseOfTheClampedCosine) {
  std::vector<double> alpha(static_cast<std::size_t>(basis_->size()));
  for (const glm::dvec3& d : {kUp, kOblique, glm::normalize(glm::dvec3(1, 1, 0))}) {
    basis_->cosine_integrals(d, alpha);
    std::vector<double> expected(alpha.size(), 0.0);
    for (const test::Node& node : sphere(d)) {
      const std::vector<double> b = basis_->evaluate(node.w);
      for (std::size_t i = 0; i < b.size(); ++i)
        expected[i] += node.weight * b[i] * std::max(0.0, glm::dot(node.w, d));
    }
    for (std::size_t i = 0; i < alpha.size(); ++i) EXPECT_NEAR(alpha[i], expected[i], 1e-11) << i;
  }
}

TEST_P(BasisOf, ConstantHasTheEnergyOfItsBestFit) {
  const std::vector<double> one = basis_->constant();
  const double squared = integral(sphere(), [&](const glm::dvec3& w) {
    const double difference = basis_->value(one, w) - 1;
    return difference * difference;
  });
  // A best fit's error is orthogonal to the fit: |1 - f|^2 = |1|^2 - Int f dw.
  EXPECT_NEAR(squared, 4 * kPi - basis_->energy(one), 1e-10);
}

TEST(Srbf, ConditionNumbers) {
  EXPECT_NEAR(make_basis("srbf4")->condition(), 14, 0.5);
  EXPECT_NEAR(make_basis("srbf6")->condition(), 1e2, 10);
  for (const char* name : {"srbf8v1", "srbf8v2", "srbf8v3"}) {
    EXPECT_GT(make_basis(name)->condition(), 1.05e3) << name;
    EXPECT_LT(make_basis(name)->condition(), 1.45e3) << name;
  }
  EXPECT_NEAR(make_basis("srbf14")->condition(), 1.8e4, 500);
  EXPECT_NEAR(make_basis("sh5")->condition(), 1, 1e-12);
}

TEST(Srbf, PoissonKernelIsItsSeries) {
  for (const double t : {-1.0, -0.3, 0.0, 0.7, 1.0}) {
    double before = 1, now = t, power = .4, sum = 1 + 3 * .4 * t;
    for (int k = 2; k < 80; ++k) {
      before = std::exchange(now, ((2 * k - 1) * t * now - (k - 1) * before) / k);
      power *= .4;
      sum += (2 * k + 1) * power * now;
    }
    EXPECT_NEAR(abel_poisson(t, .4), sum, 1e-12) << t;
  }
}

TEST(LobeQuality, OfSh2IsKnownInClosedForm) {
  // 1/4 + 1/2 cos: minimum -1/4, flux pi, peak along the axis; |max(0,t)|^2 - |fit|^2 = 2 pi/3 - 7
  // pi/12.
  const auto basis = make_basis("sh2");
  const LobeQuality quality = lobe_quality(*basis, basis->clamped_cosine(kOblique), kOblique);
  EXPECT_NEAR(quality.minimum, -0.25, 1e-12);
  EXPECT_NEAR(quality.flux, std::numbers::pi, 1e-12);
  EXPECT_NEAR(quality.peak_error_degrees, 0, 1e-4);
  EXPECT_NEAR(quality.relative_l2, std::sqrt(1.0 / 8), 1e-12);
}

TEST(LobeQuality, OfAnSrbfLobePointByPoint) {
  const auto basis = make_basis("srbf8v2");
  const std::vector<double> c = basis->clamped_cosine(kOblique);
  const LobeQuality quality = lobe_quality(*basis, c, kOblique);
  const auto nodes = test::sphere(kOblique);
  const double squared = test::integral(nodes, [&](const glm::dvec3& w) {
    const double difference = basis->value(c, w) - std::max(0.0, glm::dot(w, kOblique));
    return difference * difference;
  });
  EXPECT_NEAR(quality.relative_l2, std::sqrt(squared / (2 * std::numbers::pi / 3)), 1e-9);
  double minimum = 0, maximum = 0;
  for (const glm::dvec3& w : test::spread_axes(20000)) {
    minimum = std::min(minimum, basis->value(c, w));
    maximum = std::max(maximum, basis->value(c, w));
  }
  EXPECT_LE(quality.minimum, minimum + 1e-12);
  EXPECT_NEAR(quality.minimum, minimum, 1e-3);
  // Some direction at that distance from the axis is as high as the highest.
  double highest = 0;
  const auto [u, v] = test::across(kOblique);
  const double tilt = quality.peak_error_degrees * std::numbers::pi / 180;
  for (int i = 0; i < 720; ++i) {
    const double phi = i * std::numbers::pi / 360;
    highest = std::max(
        highest, basis->value(c, std::cos(tilt) * kOblique +
                                     std::sin(tilt) * (std::cos(phi) * u + std::sin(phi) * v)));
  }
  EXPECT_NEAR(highest, maximum, 1e-3);
}

TEST(ClampedCosine, Bands) {
  const double expected[] = {kPi, 2 * kPi / 3, kPi / 4, 0, -kPi / 24};
  for (int band = 0; band < 5; ++band)
    EXPECT_NEAR(cosine_band(band), expected[band], 1e-15) << band;
}

TEST(ClampedCosine, ChebyshevSeriesOfTheKernelText) {
  for (const double lambda : {.05, .25, .6, .9}) {
    const CosineOfPoisson g(lambda);
    const std::vector<double> c = g.chebyshev();
    for (double t = -1; t <= 1; t += 1.0 / 64) {
      const double theta = std::acos(std::clamp(2 * t * t - 1, -1.0, 1.0));
      double sum = 0;
      for (std::size_t k = 0; k < c.size(); ++k)
        sum += c[k] * std::cos(static_cast<double>(k) * theta);
      EXPECT_NEAR(sum, g.even(t), 2e-7 * c[0]) << lambda << ' ' << t;
    }
  }
}

std::string rejection(const std::string& name, double lambda) {
  return test::error_of(ExitCode::usage, [&] { make_basis(name, lambda); });
}

TEST(Rejected, IllConditionedSetsNamingLambdaAndNumber) {
  const std::string message = rejection("srbf14", 0.01);
  EXPECT_THAT(message, ::testing::HasSubstr("lambda: found 0.01 with basis srbf14"));
  EXPECT_THAT(message, ::testing::ContainsRegex("lambda: found .*condition number of [0-9.]+e\\+"));
  EXPECT_NO_THROW(make_basis("srbf4", 0.01));
}

TEST(Rejected, LambdaOutsideItsRangeAndUnknownNames) {
  for (const double lambda : {0.0, 1.0, -0.25, 2.0, std::nan("")}) {
    EXPECT_THAT(rejection("srbf8v2", lambda),
                ::testing::HasSubstr("greater than 0 and less than 1"))
        << lambda;
  }
  EXPECT_THAT(rejection("srbf7", .25), ::testing::HasSubstr("allowed: sh2, sh3, sh4, sh5, srbf4"));
}

TEST(Rejected, TwoEqualCentres) {
  EXPECT_THROW(make_basis_from_centres("twice", {kUp, kUp}), Error);
}

}  // namespace
}  // namespace clpv::basis_test
