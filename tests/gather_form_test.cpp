// SPDX-License-Identifier: MIT
// What gathering evaluates, against what it stands for: the exact irradiance of a cell's light, and closed forms.
#include "basis/gather_form.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "basis/sweep.hpp"

namespace clpv::gather_form_test {
namespace {

using std::numbers::pi;

glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// alpha(-n) . K c: the irradiance, per s^2, that the form stands for.
double exact(const Basis& basis, const Transport& transport, const std::vector<double>& c,
             const glm::dvec3& n) {
  std::vector<double> alpha(c.size());
  basis.cosine_integrals(-n, alpha);
  return dot(alpha, transport.gather * std::span<const double>(c));
}

double without_window(const GatherForm& form, const std::vector<double>& c, const glm::dvec3& n) {
  return dot(form.evaluate(-n), form.matrix() * std::span<const double>(c));
}

double with_window(const GatherForm& form, const std::vector<double>& c, const glm::dvec3& n) {
  return dot(form.windowed(form.evaluate(-n)), form.matrix() * std::span<const double>(c));
}

struct Errors {
  double rms = 0, worst = 0;  ///< over the largest exact value
};

Errors errors(const Basis& basis, const Transport& transport, const std::vector<double>& c,
              std::mt19937& random) {
  constexpr int kNormals = 200;
  const GatherForm form(basis, transport);
  Errors found;
  double largest = 0;
  for (int i = 0; i < kNormals; ++i) {
    const glm::dvec3 n = random_direction(random);
    const double e = exact(basis, transport, c, n), error = without_window(form, c, n) - e;
    largest = std::max(largest, std::abs(e));
    found.worst = std::max(found.worst, std::abs(error));
    found.rms += error * error / kNormals;
  }
  return {std::sqrt(found.rms) / largest, found.worst / largest};
}

constexpr const char* kLarge[] = {"srbf14", "sh4", "sh5", "bins24"};
constexpr TransportKind kOperators[] = {TransportKind::upwind, TransportKind::sweep};

TEST(GatherForm, NineNumbersStandForTheIrradianceOfALobe) {
  std::mt19937 random(3);
  for (const char* name : kLarge) {
    const auto basis = make_basis(name);
    for (const TransportKind of : kOperators) {
      const Transport transport = make_transport(of, *basis);
      ASSERT_TRUE(GatherForm(*basis, transport).projects());
      Errors worst;
      for (int lobe = 0; lobe < 5; ++lobe) {
        const Errors e = errors(*basis, transport, basis->clamped_cosine(random_direction(random)), random);
        worst = {std::max(worst.rms, e.rms), std::max(worst.worst, e.worst)};
      }
      RecordProperty(fmt::format("{}_{}", name, name_of(of)), std::to_string(worst.worst));
      EXPECT_LT(worst.worst, 0.03) << name << ' ' << name_of(of);
    }
  }
}

TEST(GatherForm, NineNumbersStandForTheIrradianceOfAMixture) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> positive(0, 1);
  for (const char* name : kLarge) {
    const auto basis = make_basis(name);
    for (const TransportKind of : kOperators) {
      std::vector<double> c(static_cast<std::size_t>(basis->size()), 0.0);
      for (int lobe = 0; lobe < 12; ++lobe) {
        const double power = positive(random);
        const std::vector<double> one = basis->clamped_cosine(random_direction(random));
        for (std::size_t i = 0; i < c.size(); ++i) c[i] += power * one[i];
      }
      EXPECT_LT(errors(*basis, make_transport(of, *basis), c, random).rms, 0.01)
          << name << ' ' << name_of(of);
    }
  }
}

TEST(GatherForm, UniformRadianceIsPiL) {
  // Swept light of radiance 1 is c = constant: E s^2 = pi, whatever the window.
  std::mt19937 random(5);
  for (const char* name : {"sh2", "sh3", "sh4", "sh5", "bins24"}) {
    const auto basis = make_basis(name);
    const GatherForm form(*basis, make_transport(TransportKind::sweep, *basis));
    for (int i = 0; i < 20; ++i)
      EXPECT_NEAR(with_window(form, basis->constant(), random_direction(random)), pi, 1e-9) << name;
  }
}

TEST(GatherForm, SmallBasesAreGatheredAsTheyAre) {
  std::mt19937 random(6);
  for (const char* name : {"sh2", "sh3", "srbf4", "srbf8v2"}) {
    const auto basis = make_basis(name);
    const Transport transport = make_transport(TransportKind::upwind, *basis);
    EXPECT_FALSE(GatherForm(*basis, transport).projects());
    const std::vector<double> c = basis->clamped_cosine(random_direction(random));
    EXPECT_LT(errors(*basis, transport, c, random).worst, 1e-12) << name;
  }
}

TEST(GatherForm, FaceTransportsGatherFourTimesTheIntensity) {
  std::mt19937 random(7);
  for (const char* name : {"sh2", "bins24"}) {
    const auto basis = make_basis(name);
    const GatherForm form(*basis, make_transport(TransportKind::sampled, *basis));
    EXPECT_EQ(form.window(), 0);
    const std::vector<double> c = basis->clamped_cosine(random_direction(random));
    const glm::dvec3 n = random_direction(random);
    EXPECT_NEAR(with_window(form, c, n), 4 * basis->value(c, -n), 1e-12);
  }
}

TEST(GatherForm, TheWindowIsTheLeastThatLeavesNoLobeNegative) {
  // sh2's lobe (1/4 + cos/2) gives kappa (pi/4 - pi/3) at worst and kappa pi/4 in the mean: a window of a quarter.
  const auto sh2 = make_basis("sh2");
  EXPECT_NEAR(GatherForm(*sh2, make_transport(TransportKind::upwind, *sh2)).window(), 0.25, 5e-3);
  std::mt19937 random(8);
  for (const char* name : {"sh2", "srbf4", "srbf8v2", "sh4"}) {
    const auto basis = make_basis(name);
    const GatherForm form(*basis, make_transport(TransportKind::upwind, *basis));
    double least = 0, most = 0;
    for (int i = 0; i < 400; ++i) {
      const double e =
          with_window(form, basis->clamped_cosine(random_direction(random)), random_direction(random));
      least = std::min(least, e), most = std::max(most, e);
    }
    EXPECT_GT(least, -0.005 * most) << name << ", window " << form.window();
  }
}

TEST(GatherForm, SweptLightNeedsNoWindow) {
  const auto bins = make_basis("bins24"), kept = swept_basis();
  const GatherForm form(*kept, make_transport(TransportKind::sweep, *kept));
  EXPECT_EQ(form.window(), 0);
  const Matrix projection = swept_projection();
  std::mt19937 random(9);
  double least = 0, most = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::vector<double> lobe = projection * bins->clamped_cosine(random_direction(random));
    const double e = with_window(form, lobe, random_direction(random));
    least = std::min(least, e), most = std::max(most, e);
  }
  EXPECT_GT(most, 0.5);
  EXPECT_GE(least, 0);
}

}  // namespace
}  // namespace clpv::gather_form_test
