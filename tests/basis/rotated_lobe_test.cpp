// SPDX-License-Identifier: MIT
// The paper's rotated lobes, with and without the table; and integrals of direction bins.
#include "basis/rotated_lobe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "basis/lobe_quality.hpp"
#include "basis/quadrature.hpp"
#include "basis/transport.hpp"
#include "support/error.hpp"
#include "tests/support/sphere_quadrature.hpp"

namespace clpv::rotated_lobe_test {
namespace {

using ::testing::DoubleNear;
using ::testing::Pointwise;

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kUp(0, 0, 1);
const glm::dvec3 kOblique = glm::normalize(glm::dvec3(-2, 1, -3));
const LobeOptions kRotated{LobeKind::rotate, 0};
const LobeOptions kTable{LobeKind::rotate, 256};

double error_at(const Basis& basis, const Lobes& lobes, const glm::dvec3& axis) {
  return lobe_quality(basis, lobes(axis), axis).relative_l2;
}

struct Errors {
  double up, oblique, mean;
};
struct LobeErrors {
  const char* name;
  Errors exact, rotated;
};
class LobeTable : public ::testing::TestWithParam<LobeErrors> {};
// By quadrature, and by 2000 random axes, which give means to +-0.0014.
INSTANTIATE_TEST_SUITE_P(
    Names, LobeTable,
    ::testing::Values(LobeErrors{"sh2", {.354, .354, .354}, {.354, .354, .354}},
                      LobeErrors{"sh3", {.088, .088, .088}, {.088, .088, .088}},
                      LobeErrors{"sh4", {.088, .088, .088}, {.088, .088, .088}},
                      LobeErrors{"sh5", {.044, .044, .044}, {.044, .044, .044}},
                      LobeErrors{"srbf4", {.158, .430, .399}, {.158, .432, .401}},
                      LobeErrors{"srbf6", {.123, .316, .280}, {.123, .316, .280}},
                      LobeErrors{"srbf8v1", {.118, .248, .231}, {.118, .248, .231}},
                      LobeErrors{"srbf8v2", {.356, .200, .231}, {.356, .357, .357}},
                      LobeErrors{"srbf8v3", {.117, .313, .231}, {.117, .313, .233}},
                      LobeErrors{"srbf14", {.080, .089, .087}, {.080, .090, .089}},
                      LobeErrors{"bins24", {.293, .274, .276}, {.293, .274, .276}},
                      LobeErrors{"bins96", {.150, .140, .145}, {.150, .140, .145}}),
    [](const auto& info) { return info.param.name; });

TEST_P(LobeTable, ErrorsOfExactAndOfRotatedLobes) {
  constexpr double kTolerance = .003;
  const auto basis = make_basis(GetParam().name);
  for (const LobeOptions& options : {LobeOptions{}, kRotated}) {
    const Errors& wanted = options.kind == LobeKind::exact ? GetParam().exact : GetParam().rotated;
    const Lobes lobes(*basis, options);
    EXPECT_NEAR(error_at(*basis, lobes, kUp), wanted.up, kTolerance);
    EXPECT_NEAR(error_at(*basis, lobes, kOblique), wanted.oblique, kTolerance);
    EXPECT_NEAR(mean_relative_l2(*basis, lobes), wanted.mean, kTolerance);
  }
}

TEST(Lobes, OfBasesWithoutCentresAreProjected) {
  for (const char* name : {"sh2", "sh5", "bins24"}) {
    const auto basis = make_basis(name);
    for (const glm::dvec3& axis : test::spread_axes(5)) {
      EXPECT_EQ(Lobes(*basis, kTable)(axis), basis->clamped_cosine(axis));
    }
  }
}

TEST(RotatedLobes, EqualTheRotatedLobeTowardsZ) {
  // (R c)_i = Int b_i(w) f(Rot^-1 w) dw.
  const glm::dmat3 back = glm::transpose(rotation_to(kOblique));
  const std::vector<double> lambdas{.2, .3, .25, .4, .33, .21};
  for (const auto& basis :
       {make_basis("srbf8v1"), make_basis_from_centres("uneven", even_directions(6), lambdas)}) {
    const std::vector<double> up = basis->clamped_cosine(kUp),
                              turned = basis->gram() * Lobes(*basis, kRotated)(kOblique),
                              looked_up = basis->gram() *
                                          Lobes(*basis, {LobeKind::rotate, 1 << 16})(kOblique);
    for (std::size_t i = 0; i < up.size(); ++i) {
      const double expected = test::integral(test::sphere(kUp, 40), [&](const glm::dvec3& w) {
        return basis->evaluate(w)[i] * basis->value(up, back * w);
      });
      EXPECT_NEAR(turned[i], expected, 1e-9) << basis->name() << i;
      EXPECT_NEAR(looked_up[i], expected, 1e-3) << basis->name() << i;
    }
  }
}

TEST(RotationTo, TurnsAsLittleAsPossible) {
  std::vector<glm::dvec3> axes = test::spread_axes(20);
  axes.insert(axes.end(), {kUp, -kUp, {1, 0, 0}, glm::normalize(glm::dvec3(1e-7, 0, -1))});
  for (const glm::dvec3& axis : axes) {
    const glm::dmat3 rotation = rotation_to(axis);
    EXPECT_NEAR(glm::length(rotation * kUp - axis), 0, 1e-12);
    const glm::dmat3 one = glm::transpose(rotation) * rotation;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(one[i][j], i == j, 1e-12);
    }
    EXPECT_NEAR(glm::determinant(rotation), 1, 1e-12);
    // The trace gives the angle between +z and the axis.
    EXPECT_NEAR(rotation[0][0] + rotation[1][1] + rotation[2][2], 1 + 2 * axis.z, 1e-12);
  }
  EXPECT_EQ(rotation_to(-kUp) * glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0));
}

TEST(ZonalTable, IsReadByFloor) {
  const ZonalTable table(5, [](double t) { return t; });  // -1, -0.5, 0, 0.5, 1
  const std::pair<float, double> reads[] = {{-1.0f, -1},   {-0.51f, -1},      {-0.49f, -0.5},
                                            {0.999f, 0.5}, {0.4999999f, 0},   {0.5f, 0.5},
                                            {1.0f, 1},     {1 + 0x1p-20f, 1}, {-1 - 0x1p-20f, -1}};
  for (const auto& [t, value] : reads) EXPECT_EQ(table(t), value) << t;
  EXPECT_EQ(table.values(), (std::vector<float>{-1, -0.5f, 0, 0.5f, 1}));
  EXPECT_THROW(ZonalTable(1, [](double) { return 0.0; }), Error);
  EXPECT_THROW(ZonalTable(1 << 21, [](double) { return 0.0; }), Error);
}

TEST(ZonalTable, HoldsTheBasisFunctions) {
  const auto basis = make_basis("srbf8v2");
  const ZonalTables fine = function_tables(*basis, 1 << 18);
  EXPECT_NEAR(gram_tables(*basis, 256)(0, 1), basis->gram()(0, 0), 1e-12);
  for (const glm::dvec3& w : test::spread_axes(20)) {
    EXPECT_THAT(evaluate(*basis, fine, w), Pointwise(DoubleNear(1e-4), basis->evaluate(w)));
  }
  const auto harmonics = make_basis("sh3");
  EXPECT_EQ(evaluate(*harmonics, fine, kOblique), harmonics->evaluate(kOblique));
}

// Int over each bin of max(0, w . d), split at d's horizon.
std::vector<double> bin_integrals(const Basis& bins, const glm::dvec3& d) {
  std::vector<glm::dvec3> planes = bins.creases();
  planes.push_back(d);
  std::vector<double> alpha(static_cast<std::size_t>(bins.size()), 0.0);
  for (const SphericalPolygon& part : split(octants(), planes)) {
    glm::dvec3 middle(0);
    for (const glm::dvec3& corner : part) middle += corner;
    if (glm::dot(middle, d) < 0) continue;
    const std::vector<double> b = bins.evaluate(glm::normalize(middle));
    const auto bin = static_cast<std::size_t>(std::ranges::max_element(b) - b.begin());
    for (const QuadratureNode& node : nodes_of(part))
      alpha[bin] += node.weight * glm::dot(node.w, d);
  }
  return alpha;
}

TEST(DirectionBins, CosineIntegralsAreNearTheIntegrals) {
  for (const auto& [name, largest, root_mean_square] :
       {std::tuple{"bins24", .01, .0025}, {"bins96", .033, .0045}}) {
    const auto bins = make_basis(name);
    double worst = 0, squares = 0;
    std::vector<glm::dvec3> directions = test::spread_axes(100);
    directions.insert(
        directions.end(),
        {kUp, {1, 0, 0}, glm::normalize(glm::dvec3(1, 1, 0)), glm::normalize(glm::dvec3(1))});
    for (const glm::dvec3& d : directions) {
      const std::vector<double> expected = bin_integrals(*bins, d);
      std::vector<double> alpha(expected.size());
      bins->cosine_integrals(d, alpha);
      double sum = 0;
      for (std::size_t i = 0; i < alpha.size(); ++i) {
        EXPECT_GE(alpha[i], 0);
        sum += alpha[i];
        const double difference = (alpha[i] - expected[i]) * bins->size() / kPi;
        worst = std::max(worst, std::abs(difference));
        squares += difference * difference / static_cast<double>(alpha.size() * directions.size());
      }
      EXPECT_NEAR(sum, kPi, 1e-12);
    }
    EXPECT_LT(worst, largest) << name;
    EXPECT_LT(std::sqrt(squares), root_mean_square) << name;
  }
}

TEST(DirectionBins, SplitDirectionsOnTheirEdges) {
  const auto basis = make_basis("bins24");
  const auto shares = [&](const glm::dvec3& w) {
    std::vector<double> b = basis->evaluate(glm::normalize(w));
    std::erase(b, 0.0);
    return b;
  };
  EXPECT_EQ(shares({1, 0, 0}), std::vector<double>(4, 0.25));
  EXPECT_EQ(shares({0, 1, 0.3}), std::vector<double>(2, 0.5));
  EXPECT_EQ(shares({1, 1, 0}), std::vector<double>(4, 0.25));
  EXPECT_THAT(shares({1, 1, 1}), Pointwise(DoubleNear(1e-15), std::vector<double>(3, 1.0 / 3)));
}

}  // namespace
}  // namespace clpv::rotated_lobe_test
