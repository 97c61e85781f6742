// SPDX-License-Identifier: MIT
// Identities between bases and states: six fluxes in place of coefficients, energy in single precision, sh4 as sh3.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/frame.hpp"
#include "pipeline/propagate.hpp"
#include "scene/load.hpp"
#include "tests/support/every_basis.hpp"
#include "tests/support/on_device.hpp"

namespace clpv {
namespace {

using test::EveryBasis;
using test::test_session;

double largest(const std::vector<float>& values) {
  double most = 0;
  for (const float value : values) most = std::max(most, std::abs(static_cast<double>(value)));
  return most;
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  return most;
}

constexpr int kGrid = 7, kSteps = 6;

// Volume values of `samples`^3 samples, a different direction in each; every third is empty.
std::vector<float> lobes_everywhere(const Basis& basis, int samples, int channels) {
  const auto cells = static_cast<std::size_t>(samples) * samples * samples;
  std::vector<float> values(cells * static_cast<std::size_t>(basis.size() * channels), 0.0f);
  for (std::size_t cell = 0; cell < cells; cell += 1 + cell % 2) {
    const double turn = 2.399963 * static_cast<double>(cell), z = std::cos(1.7 * static_cast<double>(cell));
    const double radius = std::sqrt(1 - z * z);
    const glm::dvec3 d(radius * std::cos(turn), radius * std::sin(turn), z);
    const std::vector<double> lobe = basis.clamped_cosine(d);
    for (std::size_t plane = 0; plane < lobe.size() * static_cast<std::size_t>(channels); ++plane) {
      const std::size_t i = plane % lobe.size(), channel = plane / lobe.size();
      values[plane * cells + cell] = static_cast<float>(lobe[i] * (0.4 + 0.3 * static_cast<double>(channel)));
    }
  }
  return values;
}

std::vector<float> propagated(const Basis& basis, const Transport& transport, State state, bool blockers) {
  Volume injected(test_session(), {kGrid, basis.size(), 3}, "injected"),
      accumulated(test_session(), {kGrid, basis.size(), 3}, "accumulated"),
      geometry(test_session(), {kGrid + 1, basis.size(), 1}, "geometry");
  injected.write(test_session(), lobes_everywhere(basis, kGrid, 3));
  geometry.write(test_session(), lobes_everywhere(basis, kGrid + 1, 1));
  Propagator(test_session(), basis, transport, {.grid = kGrid, .state = state})
      .propagate({injected, blockers ? &geometry : nullptr, accumulated}, kSteps);
  return accumulated.read(test_session());
}

TEST_P(EveryBasis, SixFluxesDoForTheCoefficients) {
  for (const TransportKind kind : {TransportKind::sampled, TransportKind::exact}) {
    const Transport transport = make_transport(kind, *basis_);
    std::vector<float> before;
    for (const bool blockers : {false, true}) {
      if (kind == TransportKind::exact && !blockers)
        continue;  // many kernels to compile, and these have the same steps
      const std::vector<float> coefficients = propagated(*basis_, transport, State::coefficients, blockers),
                               fluxes = propagated(*basis_, transport, State::fluxes, blockers);
      EXPECT_LE(largest_difference(fluxes, coefficients), 1e-5 * largest(coefficients))
          << name_of(kind) << (blockers ? ", blockers" : "");
      if (blockers && !before.empty()) {
        EXPECT_GT(largest_difference(coefficients, before), 0.01 * largest(before)) << "blocked";
      }
      before = coefficients;
    }
  }
}

// Exact transport loses nothing: the share of an isotropic source's energy that travels after 24 steps, in a grid that
// light does not leave.
TEST_P(EveryBasis, EnergyIsKeptInSinglePrecision) {
  constexpr int kTravels = 24, kCells = 2 * kTravels + 1;
  const Transport transport = make_transport(TransportKind::exact, *basis_);
  const std::size_t plane = static_cast<std::size_t>(kCells) * kCells * kCells;
  std::vector<float> light(plane * static_cast<std::size_t>(basis_->size()) * 3, 0.0f);
  std::vector<double> source = basis_->constant();
  for (std::size_t i = 0; i < source.size(); ++i) {
    source[i] *= 0.25 / std::numbers::pi;
    for (std::size_t channel = 0; channel < 3; ++channel)
      light[(channel * source.size() + i) * plane + plane / 2] = static_cast<float>(source[i]);
  }
  const VolumeShape shape{kCells, basis_->size(), 3};
  Volume injected(test_session(), shape, "injected"), accumulated(test_session(), shape, "accumulated");
  injected.write(test_session(), light);
  double energy = 0;
  Propagator(test_session(), *basis_, transport, {.grid = kCells})
      .propagate({injected, nullptr, accumulated}, kTravels, [&](int step, const Volume& travelling) {
        if (step < kTravels) return;
        const std::vector<float> values = travelling.read(test_session());
        for (std::size_t i = 0; i < source.size(); ++i) {
          double sum = 0;
          for (std::size_t cell = 0; cell < plane; ++cell)
            sum += static_cast<double>(values[i * plane + cell]);
          energy += sum * basis_->integrals()[i];
        }
      });
  EXPECT_NEAR(energy / basis_->energy(source), 1, 2e-5);
}

// Band 3 of a clamped cosine is 0, and face transports send nothing but clamped cosines.
TEST(Sh4, GivesTheImageOfSh3) {
  const Scene scene = load_scene(CLPV_SOURCE_DIR "/scenes/cornell.json", {});
  const auto indirect = [&](const char* basis) {
    RenderOptions options;
    options.basis = basis, options.transport = TransportKind::exact;
    options.width = options.height = 24, options.cascade_size = scene.cascade_size.value_or(2);
    options.grid = 10, options.cascades = 1, options.shadow_size = 64, options.rsm_size = 48;
    Frame frame(test_session(), scene, options);
    frame.render(scene.cameras.front());
    return frame.read(Show::indirect);
  };
  const std::vector<float> sh3 = indirect("sh3");
  EXPECT_LE(largest_difference(indirect("sh4"), sh3), 1e-5 * largest(sh3));
  EXPECT_GT(largest_difference(indirect("sh2"), sh3), 1e-2 * largest(sh3)) << "sh2 is another image";
}

}  // namespace
}  // namespace clpv
