// SPDX-License-Identifier: MIT
// Transports against quadrature done here: solid angles, face fluxes, energies, operators and their gather.
#include "basis/transport.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "basis/face_transport.hpp"
#include "support/error.hpp"
#include "tests/support/every_basis.hpp"
#include "tests/support/sphere_quadrature.hpp"

namespace clpv::transport_test {
namespace {

using test::EveryBasis;
using test::integral;
using test::sphere;

constexpr double kPi = std::numbers::pi;

double norm1(const glm::dvec3& w) {
  return std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

int axis_index(const glm::ivec3& normal) {
  return static_cast<int>(std::find(kAxes.begin(), kAxes.end(), normal) - kAxes.begin());
}

const FaceTransport& faces(const Transport& transport) {
  return std::get<FaceTransport>(transport.scheme);
}
const OperatorTransport& operators(const Transport& transport) {
  return std::get<OperatorTransport>(transport.scheme);
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
    EXPECT_NEAR(face.solid_angle, integral(test::square(centre, normal), [](auto) { return 1.0; }), 1e-12);
    EXPECT_NEAR(glm::length(face.direction - glm::normalize(centre)), 0, 1e-15);
    sum += face.solid_angle;
  }
  EXPECT_NEAR(sum, 4 * kPi, 1e-13);
}

TEST_P(EveryBasis, FluxesAreSamplesOrIntegralsOverTheFace) {
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

// Total coefficients after a step in free space, nothing clamped.
std::vector<double> stepped(const FaceTransport& transport, const std::vector<double>& c) {
  std::vector<double> next(c.size(), 0.0);
  for (const Face& face : transport.faces) {
    const double flux = dot(face.flux, c);
    for (std::size_t i = 0; i < c.size(); ++i)
      next[i] += flux * transport.lobes(static_cast<int>(i), axis_index(face.normal));
  }
  return next;
}

double energy_after(const Basis& basis, const Transport& transport, int steps) {
  std::vector<double> c = basis.constant();
  const double before = basis.energy(c);
  for (int step = 0; step < steps; ++step) c = stepped(faces(transport), c);
  return basis.energy(c) / before;
}

TEST_P(EveryBasis, ExactFluxesConserveEnergy) {
  const Transport transport = make_transport(TransportKind::exact, *basis_);
  EXPECT_TRUE(transport.unit_flux_lobes);
  EXPECT_NEAR(energy_after(*basis_, transport, 8), 1, 1e-13);
  EXPECT_NEAR(energy_after(*basis_, transport, 24), 1, 1e-13);
}

TEST_P(EveryBasis, LobesAreClampedCosinesAlongTheAxes) {
  const Transport sampled = make_transport(TransportKind::sampled, *basis_),
                  exact = make_transport(TransportKind::exact, *basis_);
  for (std::size_t a = 0; a < kAxes.size(); ++a) {
    const std::vector<double> lobe = basis_->clamped_cosine(glm::dvec3(kAxes[a]));
    // Unit flux changes a lobe by -.13 to +.05 %.
    EXPECT_NEAR(basis_->energy(lobe) / kPi, 1, 1.4e-3);
    std::vector<double> unit;
    for (int i = 0; i < basis_->size(); ++i) {
      EXPECT_NEAR(faces(sampled).lobes(i, static_cast<int>(a)), lobe[static_cast<std::size_t>(i)] / kPi,
                  1e-12);
      unit.push_back(faces(exact).lobes(i, static_cast<int>(a)));
    }
    EXPECT_NEAR(basis_->energy(unit), 1, 1e-12);
  }
}

struct Energies {
  const char* name;
  double after8, after24;
};
class SampledEnergy : public ::testing::TestWithParam<Energies> {};
INSTANTIATE_TEST_SUITE_P(Names, SampledEnergy,
                         ::testing::Values(Energies{"sh2", 1, 1}, Energies{"srbf4", 1.004, 1.012},
                                           Energies{"srbf8v1", 1.011, 1.032}, Energies{"srbf8v2", .964, .897},
                                           Energies{"srbf8v3", 1.043, 1.134}, Energies{"srbf14", .565, .153}),
                         [](const auto& info) { return info.param.name; });

TEST_P(SampledEnergy, DriftsAsTabled) {
  const auto basis = make_basis(GetParam().name);
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  EXPECT_NEAR(energy_after(*basis, transport, 8), GetParam().after8, 5.1e-4);
  EXPECT_NEAR(energy_after(*basis, transport, 24), GetParam().after24, 5.1e-4);
}

TEST(Clamping, GainsEnergyFromAnAxisLobe) {
  const auto basis = make_basis("sh2");
  const std::vector<double> lobe = basis->clamped_cosine({0, 0, 1});
  for (const auto& [kind, gain] : {std::pair{TransportKind::sampled, .138}, {TransportKind::exact, .115}}) {
    const Transport transport = make_transport(kind, *basis);
    double flux = 0;
    for (const Face& face : faces(transport).faces) flux += std::max(0.0, dot(face.flux, lobe));
    EXPECT_NEAR(flux / basis->energy(lobe) - 1, gain, 5.1e-4) << name_of(kind);
  }
}

TEST(Upwind, OperatorsOfSh2) {
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::upwind, *basis);
  ASSERT_EQ(operators(transport).neighbours.size(), 6u);
  const int coefficient[] = {3, 1, 2};  // of x, y, z in the order y, z, x
  for (const auto& [offset, direction, weights, against] : operators(transport).neighbours) {
    EXPECT_NEAR(weights(0, 0), 1.0 / 6, 1e-12);
    for (int a = 0; a < 3; ++a) {
      const int i = coefficient[a];
      EXPECT_NEAR(weights(0, i), offset[a] * .19462866, 1e-8);
      EXPECT_NEAR(weights(i, 0), offset[a] * .19462866, 1e-8);
      for (int b = 0; b < 3; ++b) {
        const double expected = a != b ? 0 : offset[a] == 0 ? .12168181 : .25663639;
        EXPECT_NEAR(weights(i, coefficient[b]), expected, 1e-8);
      }
    }
  }
  const double kappa = integral(sphere(), [](const glm::dvec3& w) { return 1 / norm1(w); }) / (4 * kPi);
  EXPECT_NEAR(kappa, .67421347, 1e-8);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(transport.gather(i, i), kappa, i == 0 ? 1e-12 : .5);
}

// A R_k, which is what the operators are made of, entry by entry.
TEST_P(EveryBasis, OperatorsAreMomentsOfTheirWeights) {
  const Transport transport = make_transport(TransportKind::upwind, *basis_);
  for (const auto& [offset, direction, weights, against] : operators(transport).neighbours) {
    Matrix expected(basis_->size(), basis_->size());
    for (const test::Node& node : sphere({0, 0, 1}, 16)) {
      const double weight = node.weight * std::max(0.0, glm::dot(glm::dvec3(offset), node.w)) / norm1(node.w);
      if (weight == 0) continue;
      const std::vector<double> b = basis_->evaluate(node.w);
      for (int i = 0; i < basis_->size(); ++i) {
        for (int j = 0; j < basis_->size(); ++j)
          expected(i, j) += weight * b[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)];
      }
    }
    const Matrix found = basis_->gram() * weights;
    for (int i = 0; i < basis_->size(); ++i) {
      for (int j = 0; j < basis_->size(); ++j)
        ASSERT_NEAR(found(i, j), expected(i, j), 1e-9) << i << ' ' << j;
    }
  }
}

TEST_P(EveryBasis, OperatorsKeepEnergyAndCarryABeamAlong) {
  const glm::dvec3 d = glm::normalize(glm::dvec3(3, -1, 2));
  const std::vector<double> beam = basis_->clamped_cosine(d), one = basis_->constant();
  const Transport transport = make_transport(TransportKind::upwind, *basis_);
  double energy = 0;
  glm::dvec3 drift(0);
  for (const auto& [offset, direction, weights, against] : operators(transport).neighbours) {
    const double part = basis_->energy(weights * beam);
    energy += part;
    drift += part * glm::dvec3(offset);
  }
  EXPECT_NEAR(energy / basis_->energy(beam), 1, 1e-12);
  // What a cell sends is weighed with the basis's best 1; w / |w|_1 is the way of a step.
  for (int a = 0; a < 3; ++a) {
    const double expected = integral(sphere(), [&](const glm::dvec3& w) {
      return basis_->value(one, w) * basis_->value(beam, w) * w[a] / norm1(w);
    });
    EXPECT_NEAR(drift[a], expected, 1e-10);
  }
  EXPECT_GT(glm::dot(glm::normalize(drift), d), .98);
}

// Irradiance from a uniform radiance of 1 W/(m^2 sr), in cells of 1 m.
double gathered(const Basis& basis, const Transport& transport, const glm::dvec3& normal) {
  std::vector<double> moments(static_cast<std::size_t>(basis.size()), 0.0), alpha(moments.size());
  for (const test::Node& node : sphere()) {
    const double intensity = transport.kind == TransportKind::upwind ? norm1(node.w) : 1;
    const std::vector<double> b = basis.evaluate(node.w);
    for (std::size_t i = 0; i < b.size(); ++i) moments[i] += node.weight * intensity * b[i];
  }
  basis.cosine_integrals(-normal, alpha);
  return dot(alpha, transport.gather * (basis.gram_inverse() * moments));
}

TEST_P(EveryBasis, GatherOfAUniformFieldIsPi) {
  for (const TransportKind kind : {TransportKind::upwind, TransportKind::sweep}) {
    const Transport transport = make_transport(kind, *basis_);
    EXPECT_TRUE(transport.gathers_cosine);
    // Upwind: |w|_1 is a best fit on the basis, which the few functions cannot make flat again.
    const double allowed = transport.kind == TransportKind::upwind ? .02 : .002;
    for (const glm::dvec3& n : {glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(1, -2, .5))})
      EXPECT_NEAR(gathered(*basis_, transport, n) / kPi, 1, allowed) << name_of(kind);
  }
}

TEST(Octahedral, OperatorsArePermutationsOfOne) {
  for (const char* basis_name : {"srbf6", "srbf8v2", "srbf14"}) {
    const auto basis = make_basis(basis_name);
    const auto transport = make_transport(TransportKind::upwind, *basis);
    const auto& neighbours = operators(transport).neighbours;
    // x -> y -> z -> x maps the centres onto themselves, and the operator of +x onto that of +y.
    std::vector<int> image;
    for (const glm::dvec3& c : basis->centres()) {
      const glm::dvec3 turned(c.z, c.x, c.y);
      for (int j = 0; j < basis->size(); ++j) {
        if (glm::length(basis->centres()[static_cast<std::size_t>(j)] - turned) < 1e-12) image.push_back(j);
      }
    }
    ASSERT_EQ(image.size(), basis->centres().size());
    for (int i = 0; i < basis->size(); ++i) {
      for (int j = 0; j < basis->size(); ++j)
        EXPECT_NEAR(
            neighbours[0].weights(i, j),
            neighbours[2].weights(image[static_cast<std::size_t>(i)], image[static_cast<std::size_t>(j)]),
            1e-9);
    }
  }
}

}  // namespace
}  // namespace clpv::transport_test
