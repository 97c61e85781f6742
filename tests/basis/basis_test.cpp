// SPDX-License-Identifier: MIT
// Bases against quadrature done here: Gram matrices, integrals of the clamped cosine, quality of
// its lobe.

#include "basis/basis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "basis/bases.hpp"
#include "basis/clamped_cosine.hpp"
#include "basis/lobe_quality.hpp"
#include "basis/matrix.hpp"
#include "basis/sweep.hpp"
#include "basis/transport.hpp"
#include "kernels/shared/sweep.h"
#include "support/literals.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sphere_quadrature.hpp"

namespace clpv::test::basis_test {

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

// Tables for kernels as text, and the order of bins and links that kernels of the sweep rely on.

TEST(Constants, RoundingErrorsOfZerosAreZero) {
  Matrix matrix(2, 2);
  matrix(0, 0) = 0.5;
  matrix(0, 1) = -1e-14;
  matrix(1, 1) = -0.5;
  EXPECT_EQ(Literals().matrix("CLPV_M", matrix).defined().at("CLPV_M"),
            "{{0.5f, 0.0f}, \\\n  {0.0f, (-0.5f)}}");
}

// Sets of SRBF centres: files of them, and a lambda for each centre.

using ::testing::HasSubstr;

class CentresFile : public ::testing::Test {
 protected:
  std::string file(const std::string& text) {
    const std::string path = (folder_.path() / "mine.json").string();
    std::ofstream(path) << text;
    return path;
  }
  void expect_rejected(const std::string& path, const std::string& word) {
    EXPECT_THAT(test::error_of(ExitCode::bad_input, [&] { load_basis(path); }),
                ::testing::AllOf(HasSubstr(path), HasSubstr(word)));
  }
  test::TemporaryFolder folder_;
};

const char* const kAxesFile = R"({"name": "axes", "centres":
    [[2, 0, 0], [-1e200, 0, 0], [0, 1, 0], [0, -3, 0], [0, 0, 1e-200], [0, 0, -1]]})";

TEST_F(CentresFile, MakesTheBasis) {
  const auto basis = load_basis(file(kAxesFile), 0.3);
  const auto named = make_basis("srbf6", 0.3);
  EXPECT_EQ(basis->name(), "axes");
  EXPECT_EQ(basis->centres(), named->centres());
  EXPECT_EQ(basis->condition(), named->condition());
  EXPECT_EQ(load_basis(file(R"({"centres": [[0, 0, 1]]})"))->name(), "mine");
}

TEST_F(CentresFile, RejectsWithThePlace) {
  const std::pair<std::string, std::string> bad[] = {
      {"{", "invalid JSON"},
      {"[1]", "object"},
      {"{}", "/centres is missing"},
      {R"({"centres": []})", "1 to 64"},
      {R"({"centres": 7})", "is 7"},
      {R"({"centres": [[0, 0, 1], [1, 2]]})", "/centres/1"},
      {R"({"centres": [[0, 0, 0]]})", "/centres/0"},
      {R"({"centres": [[0, 0, "1"]]})", "/centres/0/2"},
      {R"({"centres": [[0, 0, 1e999]]})", "invalid JSON"},
      {R"({"centres": [[0, 0, 1], [0, 0, 5]]})", "/centres/1"},
      {R"({"centres": [[0, 0, 1]], "lambda": 1})",
       "/lambda is 1; allowed: a number greater than 0 and less than 1"},
      {R"({"centres": [[0, 0, 1]], "lambda": "wide"})", "/lambda is \"wide\""},
      {R"({"centres": [[0, 0, 1], [1, 0, 0]], "lambda": [0.2, 0]})", "/lambda/1 is 0"},
      {R"({"centres": [[0, 0, 1], [1, 0, 0]], "lambda": [0.2]})",
       "/lambda is an array of 1; allowed: a number, or 2"},
      {R"({"centres": [[0, 0, 1], [0.01, 0, 1]], "lambda": 0.01})", "condition number"},
      {R"({"centres": [[0, 0, 1]], "lambdas": 0.2})", "lambdas"},
      {R"({"centres": [[0, 0, 1]], "name": 3})", "/name"},
      {std::string(100000, '['), "nested more than"},
      {std::string(2 << 20, ' '), "bytes"},
  };
  for (const auto& [text, word] : bad) expect_rejected(file(text), word);
  std::string many = "[[0,0,1]";
  for (int i = 1; i < 65; ++i) many += ",[" + std::to_string(i) + ",1,0]";
  expect_rejected(file("{\"centres\": " + many + "]}"), "array of 65");
  expect_rejected((folder_.path() / "none.json").string(), "no file");
  expect_rejected(folder_.path().string(), "a folder");
}

// Transports against quadrature done here: solid angles, face fluxes, energies.

const FaceTransport& faces(const Transport& transport) {
  return std::get<FaceTransport>(transport.scheme);
}
TEST(SolidAngles, AreThoseOfTheFacesAndSumToTheSphere) {
  EXPECT_NEAR(far_solid_angle(), 0.4006696846462392, 1e-15);
  EXPECT_NEAR(side_solid_angle(), 0.4234313544367390, 1e-15);
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  ASSERT_EQ(faces(transport).faces.size(), 30u);
  double sum = 0;
  for (const Face& face : faces(transport).faces) {
    const glm::dvec3 normal(face.normal), centre = glm::dvec3(face.travel) + 0.5 * normal;
    EXPECT_NEAR(face.solid_angle, integral(test::square(centre, normal), [](auto) { return 1.0; }),
                1e-12);
    EXPECT_NEAR(glm::length(face.direction - glm::normalize(centre)), 0, 1e-15);
    sum += face.solid_angle;
  }
  EXPECT_NEAR(sum, 4 * kPi, 1e-13);
}

struct TransportOf : test::EveryBasis {};
INSTANTIATE_TEST_SUITE_P(Names, TransportOf, ::testing::ValuesIn(test::smooth_bases()),
                         [](const auto& info) { return info.param; });

TEST_P(TransportOf, FluxesAreSamplesOrIntegralsOverTheFace) {
  const Transport sampled = make_transport(TransportKind::sampled, *basis_),
                  exact = make_transport(TransportKind::exact, *basis_);
  for (std::size_t f = 0; f < 30; ++f) {
    const Face &at_centre = faces(sampled).faces[f], &over_cone = faces(exact).faces[f];
    const glm::dvec3 normal(at_centre.normal);
    const auto nodes = test::square(glm::dvec3(at_centre.travel) + 0.5 * normal, normal);
    const std::vector<double> b = basis_->evaluate(at_centre.direction);
    std::vector<double> expected(b.size(), 0.0);
    for (const test::Node& node : nodes) {
      const std::vector<double> value = basis_->evaluate(node.w);
      for (std::size_t i = 0; i < b.size(); ++i) expected[i] += node.weight * value[i];
    }
    for (std::size_t i = 0; i < b.size(); ++i) {
      EXPECT_NEAR(at_centre.flux[i], at_centre.solid_angle * b[i], 1e-14);
      EXPECT_NEAR(over_cone.flux[i], expected[i], 1e-11);
    }
  }
}

TEST_P(TransportOf, LobesAreClampedCosinesAlongTheAxes) {
  const Transport sampled = make_transport(TransportKind::sampled, *basis_),
                  exact = make_transport(TransportKind::exact, *basis_);
  for (std::size_t a = 0; a < kAxes.size(); ++a) {
    const std::vector<double> lobe = basis_->clamped_cosine(glm::dvec3(kAxes[a]));
    // Unit flux changes a lobe by -0.13 to +0.05 %.
    EXPECT_NEAR(basis_->energy(lobe) / kPi, 1, 1.4e-3);
    std::vector<double> unit;
    for (int i = 0; i < basis_->size(); ++i) {
      EXPECT_NEAR(faces(sampled).lobes(i, static_cast<int>(a)),
                  lobe[static_cast<std::size_t>(i)] / kPi, 1e-12);
      unit.push_back(faces(exact).lobes(i, static_cast<int>(a)));
    }
    EXPECT_NEAR(basis_->energy(unit), 1, 1e-12);
  }
}

}  // namespace
}  // namespace clpv::test::basis_test
