// SPDX-License-Identifier: MIT
// The baseline by hand against the twin.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "bench/baseline/propagate_avx2.hpp"
#include "reference/propagate.hpp"
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

}  // namespace
}  // namespace clpv::bench
