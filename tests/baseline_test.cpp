// SPDX-License-Identifier: MIT
// The baselines by hand against the twins.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "bench/baseline/propagate_avx2.hpp"
#include "bench/baseline/sweep_avx2.hpp"
#include "checks/check_inputs.hpp"
#include "checks/tolerances.hpp"
#include "reference/propagate.hpp"
#include "reference/sweep.hpp"
#include "support/error.hpp"

namespace clpv::bench {
namespace {

/// Light in some cells, blockers at some corners, both at random.
struct Scene {
  reference::Volume light, geometry;
  Scene(const Basis& basis, int n) : light(n, basis.size()), geometry(n + 1, basis.size(), 1) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (double& value : light.values) value = std::max(0.0f, uniform(random));
    for (double& value : geometry.values) value = 0.3f * uniform(random);
  }
};

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = a.size() == b.size() ? 0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

TEST(Baseline, IsTheTwin) {
  if (!baseline_supported()) GTEST_SKIP() << "no AVX2";
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  const Scene scene(*basis, 8);
  PropagateBaseline baseline(*basis, transport, 8);
  const std::vector<float> light(scene.light.values.begin(), scene.light.values.end());
  const std::vector<float> corners(scene.geometry.values.begin(), scene.geometry.values.end());
  for (const bool blocked : {false, true}) {
    baseline.set(light, blocked ? &corners : nullptr);
    baseline.propagate(4);
    const std::vector<float> found = baseline.accumulated();
    const auto plain = reference::propagate(transport, scene.light, blocked ? &scene.geometry : nullptr, 4);
    double most = 0;
    for (const double value : plain.accumulated.values) most = std::max(most, std::abs(value));
    EXPECT_LT(largest_difference({found.begin(), found.end()}, plain.accumulated.values), 2e-6 * most)
        << (blocked ? "blocked" : "free");
  }
  EXPECT_THROW(PropagateBaseline(*basis, transport, 12), Error);
}

TEST(Baseline, OfTheSweepIsTheTwin) {
  if (!baseline_supported()) GTEST_SKIP() << "no AVX2";
  const auto basis = make_basis("bins24");
  const Transport transport = make_transport(TransportKind::sweep, *basis, {}, Blocking::areas);
  std::mt19937 random(3);
  for (const auto& [grid, parts] : {std::pair{16, 2}, {8, 1}, {8, 3}}) {
    const reference::Volume light = reference::random_light(*basis, grid, random),
                            areas = reference::random_blockers(3, grid, random);
    const std::vector<float> injected(light.values.begin(), light.values.end());
    const std::vector<float> corners(areas.values.begin(), areas.values.end());
    SweepBaseline baseline(*basis, transport, grid, parts);
    for (const bool blocked : {true, false, true}) {
      baseline.set(injected, blocked ? &corners : nullptr);
      baseline.sweep();
      const std::vector<float> found = baseline.accumulated();
      reference::SweptCascade cascade{{}, &light, blocked ? &areas : nullptr, parts};
      cascade.grid.n = static_cast<unsigned>(grid), cascade.grid.cell = 1;
      const reference::Volume twin =
          reference::kept_of(reference::sweep(*basis, transport, {cascade}).front());
      double most = 0;
      for (const double value : twin.values) most = std::max(most, std::abs(value));
      EXPECT_LT(largest_difference({found.begin(), found.end()}, twin.values),
                reference::tolerance("sweep") * most)
          << grid << "^3, parts " << parts << (blocked ? ", blocked" : ", free");
    }
  }
}

TEST(Baseline, OfTheSweepRefusesWhatItIsNotMadeFor) {
  if (!baseline_supported()) GTEST_SKIP() << "no AVX2";
  const auto bins = make_basis("bins24"), harmonics = make_basis("sh2");
  const auto transport = [](const Basis& basis, Blocking blocking) {
    return make_transport(TransportKind::sweep, basis, {}, blocking);
  };
  EXPECT_THROW(SweepBaseline(*bins, transport(*bins, Blocking::areas), 12, 2), Error);
  EXPECT_THROW(SweepBaseline(*bins, transport(*bins, Blocking::two_sided), 8, 2), Error);
  EXPECT_THROW(SweepBaseline(*bins, make_transport(TransportKind::sampled, *bins), 8, 2), Error);
  EXPECT_THROW(SweepBaseline(*harmonics, transport(*harmonics, Blocking::areas), 8, 2), Error);
}

}  // namespace
}  // namespace clpv::bench
