// SPDX-License-Identifier: MIT
// Propagation: kernels against the CPU reference, and the CPU reference against closed forms.
#include "pipeline/propagate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference/propagate.hpp"
#include "tests/support/on_device.hpp"

namespace clpv::propagate_test {
namespace {

using test::expect_passed;
using test::test_session;

reference::Volume one_source(const Basis& basis, int n, const std::vector<double>& c, glm::ivec3 at) {
  reference::Volume volume(n, basis.size());
  for (int channel = 0; channel < 3; ++channel) {
    for (int i = 0; i < basis.size(); ++i)
      volume.at(channel, i, at.x, at.y, at.z) = c[static_cast<std::size_t>(i)];
  }
  return volume;
}

std::vector<double> isotropic(const Basis& basis) {
  std::vector<double> c = basis.constant();
  for (double& value : c) value *= 0.25 / std::numbers::pi;
  return c;
}

std::vector<double> axis_lobe(const Basis& basis) {
  std::vector<double> c = basis.clamped_cosine({0, 0, 1});
  for (double& value : c) value /= std::numbers::pi;
  return c;
}

/// Energy after each step of the kernels, from one source, red channel.
std::vector<double> device_energies(const Basis& basis, const Transport& transport,
                                    const reference::Volume& light, int steps,
                                    const reference::Volume* blockers = nullptr) {
  Session& session = test_session();
  Volume injected(session, {light.n, basis.size(), 3}, "injected"),
      accumulated(session, {light.n, basis.size(), 3}, "sum");
  injected.write(session, std::vector<float>(light.values.begin(), light.values.end()));
  std::optional<Volume> geometry;
  if (blockers != nullptr) {
    geometry.emplace(session, VolumeShape{light.n + 1, basis.size(), 1}, "geometry");
    geometry->write(session, std::vector<float>(blockers->values.begin(), blockers->values.end()));
  }
  std::vector<double> energies{reference::energy(basis, light)[0]};
  Propagator propagator(session, basis, transport, {.grid = light.n});
  propagator.propagate({injected, geometry ? &*geometry : nullptr, accumulated}, steps,
                       [&](int, const Volume& travelling) {
                         const std::vector<float> values = travelling.read(session);
                         reference::Volume copy(light.n, basis.size());
                         copy.values.assign(values.begin(), values.end());
                         energies.push_back(reference::energy(basis, copy)[0]);
                       });
  return energies;
}

TEST(Propagate, KernelsAgreeWithTheReference) {
  expect_passed(reference::check(Stage::propagate, test_session(), test::few_variants()));
}

TEST(Propagate, EmptyFieldStaysExactlyZero) {
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  for (const double e : device_energies(*basis, transport, reference::Volume(6, basis->size()), 4))
    EXPECT_EQ(e, 0.0);
}

TEST(Propagate, IsotropicSourceKeepsItsEnergy) {
  const auto basis = make_basis("sh2");
  for (const TransportKind kind : {TransportKind::sampled, TransportKind::exact}) {
    const Transport transport = make_transport(kind, *basis);
    for (const double e :
         device_energies(*basis, transport, one_source(*basis, 19, isotropic(*basis), {9, 9, 9}), 8))
      EXPECT_NEAR(e, 1.0, 1e-5) << name_of(kind);
  }
}

TEST(Propagate, AxisLobeGainsByClampingOnceAndKeepsIt) {
  const auto basis = make_basis("sh2");
  const Transport sampled = make_transport(TransportKind::sampled, *basis),
                  exact = make_transport(TransportKind::exact, *basis);
  const auto light = one_source(*basis, 19, axis_lobe(*basis), {9, 9, 9});
  const auto energies = device_energies(*basis, sampled, light, 8);
  EXPECT_NEAR(energies[1] / energies[0], 1.1382, 1e-4);
  EXPECT_NEAR(energies[8] / energies[0], 1.1382, 1e-4);
  const auto exact_energies = device_energies(*basis, exact, light, 1);
  EXPECT_NEAR(exact_energies[1] / exact_energies[0], 1.115, 1e-3);
}

TEST(Propagate, UnclampedExactTransportConservesEnergyOfEveryBasis) {
  for (const std::string& name : basis_names()) {
    const auto basis = make_basis(name);
    if (basis->size() > 30) continue;  // bins96 take too long
    const Transport transport = make_transport(TransportKind::exact, *basis);
    const auto light = one_source(*basis, 9, isotropic(*basis), {4, 4, 4});
    const auto end = reference::propagate(transport, light, nullptr, 3, false);
    EXPECT_NEAR(reference::energy(*basis, end.travelling)[0] / reference::energy(*basis, light)[0], 1.0,
                1e-13)
        << name;
  }
}

TEST(Propagate, UniformIsotropicFieldStaysAsItIsAwayFromTheBorder) {
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  reference::Volume light(9, basis->size());
  const auto c = isotropic(*basis);
  for (int channel = 0; channel < 3; ++channel) {
    for (int i = 0; i < basis->size(); ++i) {
      for (int cell = 0; cell < 729; ++cell)
        light.at(channel, i, cell % 9, cell / 9 % 9, cell / 81) = c[static_cast<std::size_t>(i)];
    }
  }
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
      blockers.at(0, i, corner % (n + 1), corner / (n + 1), wall) = one[static_cast<std::size_t>(i)];
  }
  const auto behind = [&](const reference::Volume* geometry) {
    const auto end = reference::propagate(transport, light, geometry, 12).accumulated;
    double sum = 0;
    for (int z = wall; z < n; ++z) {
      for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) sum += end.value(0, 0, x, y, z);
      }
    }
    return sum;
  };
  EXPECT_LT(behind(&blockers), 0.10 * behind(nullptr));
}

TEST(Propagate, WhatIsLostIsWhatLeavesTheGrid) {
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  // Isotropic light is never clamped: before = after + lost.
  const auto light = one_source(*basis, 3, isotropic(*basis), {0, 1, 1});
  const auto next = reference::propagate_step(transport, light, nullptr);
  EXPECT_NEAR(reference::energy(*basis, next)[0] + reference::leaving(*basis, transport, light)[0], 1.0,
              2e-5);
  EXPECT_GT(reference::leaving(*basis, transport, light)[0], 0.1);
}

TEST(Propagate, AnAlteredLiteralIsCaught) {
  // The CPU reference takes its constants from the transport; so does the kernel. Alter one on the kernel's side
  // alone.
  const auto basis = make_basis("sh2");
  Transport altered = make_transport(TransportKind::sampled, *basis);
  std::get<FaceTransport>(altered.scheme).faces[3].flux[0] *= 1.001;
  const auto light = one_source(*basis, 5, isotropic(*basis), {2, 2, 2});
  const auto kernel = device_energies(*basis, altered, light, 2);
  const auto expected =
      reference::propagate(make_transport(TransportKind::sampled, *basis), light, nullptr, 2);
  EXPECT_GT(std::abs(kernel[2] - reference::energy(*basis, expected.travelling)[0]), 1e-5);
}

}  // namespace
}  // namespace clpv::propagate_test
