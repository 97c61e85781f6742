// SPDX-License-Identifier: MIT
// Bases against quadrature done here: Gram matrices, integrals of the clamped cosine, quality of
// its lobe.

#include "basis/basis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "basis/bases.hpp"
#include "basis/clamped_cosine.hpp"
#include "basis/lobe_quality.hpp"
#include "basis/matrix.hpp"
#include "basis/quadrature.hpp"
#include "basis/rotated_lobe.hpp"
#include "basis/sweep.hpp"
#include "basis/transport.hpp"
#include "kernels/shared/sweep.h"
#include "support/error.hpp"
#include "support/literals.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sphere_quadrature.hpp"
#include "verify/jobs.hpp"

namespace clpv::test::basis_test {

namespace {

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

struct CentresFile : ::testing::Test {
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
      {"{}", "/centres: found nothing"},
      {R"({"centres": []})", "1 to 64"},
      {R"({"centres": [[0, 0, 1], [1, 2]]})", "/centres/1"},
      {R"({"centres": [[0, 0, 0]]})", "/centres/0"},
      {R"({"centres": [[0, 0, 1], [0, 0, 5]]})", "centres 0 and 1: found a distance of 0"},
      {R"({"centres": [[0, 0, 1]], "lambda": 1})",
       "lambda: found 1, allowed: greater than 0 and less than 1"},
      {R"({"centres": [[0, 0, 1], [1, 0, 0]], "lambda": [0.2, 0]})", "lambda: found 0, allowed"},
      {R"({"centres": [[0, 0, 1], [1, 0, 0]], "lambda": [0.2, -1]})", "/lambda/1: found -1"},
      {R"({"centres": [[0, 0, 1], [1, 0, 0]], "lambda": [0.2]})",
       "/lambda: found an array of 1; allowed: an array of 2 to 2"},
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

// The paper's rotated lobes, with and without the table; and integrals of direction bins.

using ::testing::DoubleNear;
using ::testing::Pointwise;

const LobeOptions kRotated{LobeKind::rotate, 0};
const LobeOptions kTable{LobeKind::rotate, 256};

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

// Functions of kernels/basis/ on the device: injection takes integrals of the clamped cosine and
// projects them, gathering evaluates functions. Both are held against the CPU reference.

void expect_agreement(const std::shared_ptr<const Basis>& basis, const LobeOptions& lobes = {}) {
  Session& session = test_session();
  for (const verify::Job& job :
       {verify::inject_job(session, verify::random_injection(session, basis, {.lobes = lobes}, true,
                                                             true, RsmFormat::float32)),
        verify::gather_job(session, verify::random_gathering(session, basis, TransportKind::sampled,
                                                             {.grid = 9, .lobes = lobes}))}) {
    job.run();
    const verify::Deviation found = job.compare();
    EXPECT_TRUE(found.passed()) << basis->name() << ": " << found.worst << " at " << found.place;
  }
}

// Bases of the same kind differ from these by numbers only; `clpv check --thorough` has them.
TEST(BasisKernels, FunctionsIntegralsAndLobesAreThoseInDouble) {
  for (const char* name : {"sh5", "srbf8v2", "bins24"}) expect_agreement(make_basis(name));
}

// Series by Chebyshev polynomials, and of several lengths.
TEST(RadialKernels, LargeAndUnevenLambdas) {
  expect_agreement(make_basis("srbf8v3", 0.8));
  expect_agreement(make_basis_from_centres("uneven", make_basis("srbf4")->centres(),
                                           std::vector<double>{0.2, 0.3, 0.7, 0.25}));
}

TEST(RadialKernels, RotatedLobes) {
  expect_agreement(make_basis("srbf8v2"), {.kind = LobeKind::rotate});
}

}  // namespace
}  // namespace clpv::test::basis_test
