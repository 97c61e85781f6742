// SPDX-License-Identifier: MIT
// Propagation: the CPU reference against closed forms.
#include "reference/propagate.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/numbers.hpp"

namespace clpv::propagate_test {
namespace {

reference::Volume one_source(const Basis& basis, int n, const std::vector<double>& c,
                             glm::ivec3 at) {
  reference::Volume volume(n, basis.size());
  for (int channel = 0; channel < 3; ++channel) {
    for (int i = 0; i < basis.size(); ++i)
      volume.at(channel, i, at.x, at.y, at.z) = c[static_cast<std::size_t>(i)];
  }
  return volume;
}

std::vector<double> isotropic(const Basis& basis) {
  return test::times(0.25 / std::numbers::pi, basis.constant());
}

std::vector<double> axis_lobe(const Basis& basis) {
  return test::times(1 / std::numbers::pi, basis.clamped_cosine({0, 0, 1}));
}

/// Energy before the first step and after each, red channel, by the CPU reference.
std::vector<double> energies(const Basis& basis, TransportKind kind, reference::Volume light,
                             int steps) {
  const Transport transport = make_transport(kind, basis);
  std::vector<double> all{reference::energy(basis, light)[0]};
  for (int step = 0; step < steps; ++step) {
    light = reference::propagate_step(transport, light, nullptr);
    all.push_back(reference::energy(basis, light)[0]);
  }
  return all;
}

TEST(Propagate, IsotropicSourceKeepsItsEnergy) {
  const auto basis = make_basis("sh2");
  for (const TransportKind kind : {TransportKind::sampled, TransportKind::exact}) {
    for (const double e :
         energies(*basis, kind, one_source(*basis, 19, isotropic(*basis), {9, 9, 9}), 8))
      EXPECT_NEAR(e, 1.0, 1e-5) << name_of(kind);
  }
}

TEST(Propagate, AxisLobeGainsByClampingOnceAndKeepsIt) {
  const auto basis = make_basis("sh2");
  const auto light = one_source(*basis, 19, axis_lobe(*basis), {9, 9, 9});
  const auto sampled = energies(*basis, TransportKind::sampled, light, 8);
  EXPECT_NEAR(sampled[1] / sampled[0], 1.1382, 1e-4);
  EXPECT_NEAR(sampled[8] / sampled[0], 1.1382, 1e-4);
  const auto exact = energies(*basis, TransportKind::exact, light, 1);
  EXPECT_NEAR(exact[1] / exact[0], 1.115, 1e-3);
}

TEST(Propagate, AUniformFieldIsConstantAwayFromTheBorder) {
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  reference::Volume light(9, basis->size());
  const auto c = isotropic(*basis);
  for (std::size_t i = 0; i < light.values.size(); ++i) light.values[i] = c[i / 729 % c.size()];
  const auto end = reference::propagate(transport, light, nullptr, 3);
  for (int i = 0; i < basis->size(); ++i)
    EXPECT_NEAR(end.travelling.value(0, i, 4, 4, 4), c[static_cast<std::size_t>(i)], 1e-14);
}

TEST(Propagate, LittleLightArrivesBehindAWallOfFullBlockers) {
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  const int n = 16, wall = 8;
  const auto light = one_source(*basis, n, isotropic(*basis), {8, 8, 4});
  reference::Volume blockers(n + 1, basis->size(), 1);
  const auto one = basis->constant();
  for (int corner = 0; corner < (n + 1) * (n + 1); ++corner) {
    for (int i = 0; i < basis->size(); ++i)
      blockers.at(0, i, corner % (n + 1), corner / (n + 1), wall) =
          one[static_cast<std::size_t>(i)];
  }
  const auto behind = [&](const reference::Volume* geometry) {
    const auto end = reference::propagate(transport, light, geometry, 12).accumulated;
    double sum = 0;
    reference::for_each_cell(
        n, [&](const glm::ivec3& p) { sum += p.z < wall ? 0 : end.value(0, 0, p.x, p.y, p.z); });
    return sum;
  };
  EXPECT_LT(behind(&blockers), 0.10 * behind(nullptr));
}

TEST(Propagate, OnlyLightThatLeavesTheGridIsLost) {
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  // Isotropic light is never clamped: before = after + lost.
  const auto light = one_source(*basis, 3, isotropic(*basis), {0, 1, 1});
  const auto next = reference::propagate_step(transport, light, nullptr);
  EXPECT_NEAR(
      reference::energy(*basis, next)[0] + reference::escaping_energy(*basis, transport, light)[0],
      1.0, 2e-5);
  EXPECT_GT(reference::escaping_energy(*basis, transport, light)[0], 0.1);
}

}  // namespace
}  // namespace clpv::propagate_test
