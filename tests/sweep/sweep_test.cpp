// SPDX-License-Identifier: MIT
// The sweep against closed forms, by the CPU reference.
#include "pipeline/sweep/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/steps/propagate.hpp"
#include "reference/sweep.hpp"
#include "support/error.hpp"
#include "tests/support/on_device.hpp"
#include "verify/check.hpp"

namespace clpv::sweep_test {
using namespace test;
using reference::SweptCascade;

constexpr double kExact = 1e-12;
constexpr double kFloat = 2e-6;  // relative: some dozen roundings of float32

Transport swept_by(const Basis& basis) {
  return make_transport(TransportKind::sweep, basis, {}, Blocking::areas);
}

class EachPartition : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Sweep, EachPartition, ::testing::Range(1, kMaxSweepParts + 1));

TEST_P(EachPartition, DirectionsAreAQuadratureOfTheSphere) {
  double whole = 0, isotropic = 0;
  glm::dvec3 sum(0);
  for (const SweepBin& bin : sweep_bins(GetParam())) {
    EXPECT_EQ(bin.directions.size(), static_cast<std::size_t>(GetParam() * GetParam()));
    double of_bin = 0;
    for (const SweepDirection& d : bin.directions) {
      EXPECT_NEAR(glm::length(d.w), 1, kExact);
      EXPECT_NEAR(d.taps[0] + d.taps[1] + d.taps[2] + d.taps[3], 1, kExact);
      for (const double tap : d.taps) EXPECT_GE(tap, 0);
      glm::dvec3 way(0);  // the taps' mean offset is the way from plane to plane
      for (std::size_t k = 0; k < d.taps.size(); ++k) way += d.taps[k] * glm::dvec3(bin.offset[k]);
      EXPECT_LT(glm::length(way * d.flux - d.w), kExact);
      of_bin += d.solid_angle;
      sum += d.solid_angle * d.w;
      isotropic += d.solid_angle * d.w.x * d.w.x;
    }
    EXPECT_NEAR(of_bin, bin.solid_angle, kExact);
    EXPECT_NEAR(bin.solid_angle, std::numbers::pi / 6, kExact);
    whole += of_bin;
  }
  EXPECT_NEAR(whole, 4 * std::numbers::pi, kExact);
  EXPECT_LT(glm::length(sum), kExact);
  EXPECT_NEAR(isotropic, 4 * std::numbers::pi / 3, kExact);
}

TEST(Sweep, BinsAreThoseOfTheBasis) {
  const auto basis = make_basis("bins24");
  const std::vector<SweepBin> bins = sweep_bins(2);
  for (int b = 0; b < kSweepBins; ++b) {
    for (const SweepDirection& d : bins[static_cast<std::size_t>(b)].directions)
      EXPECT_EQ(basis->evaluate(d.w)[static_cast<std::size_t>(b)], 1) << b;
  }
  const Matrix means = part_means(*basis, 1);
  for (int i = 0; i < kSweepBins; ++i) {
    for (int j = 0; j < kSweepBins; ++j) EXPECT_NEAR(means(i, j), i == j ? 1 : 0, kExact);
  }
}

TEST(Sweep, MeansKeepTheEnergyOfEveryBasis) {
  for (const std::string& name : basis_names()) {
    const auto basis = make_basis(name);
    const Matrix means = part_means(*basis, 2);
    const std::vector<SweepBin> bins = sweep_bins(2);
    for (int i = 0; i < basis->size(); ++i) {
      double sum = 0;
      for (int d = 0; d < means.rows(); ++d)
        sum += bins[static_cast<std::size_t>(d / 4)]
                   .directions[static_cast<std::size_t>(d % 4)]
                   .solid_angle *
               means(d, i);
      EXPECT_NEAR(sum, basis->integrals()[static_cast<std::size_t>(i)], 1e-9) << name << ' ' << i;
    }
  }
}

TEST(Sweep, HarmonicsKeptAreTheProjectionOfTheBins) {
  const Matrix projection = swept_projection();
  ASSERT_EQ(projection.rows(), swept_basis()->size());
  for (int j = 0; j < projection.rows(); ++j) {
    double uniform = 0;
    for (int b = 0; b < kSweepBins; ++b) uniform += projection(j, b);
    EXPECT_NEAR(uniform, j == 0 ? 2 * std::sqrt(std::numbers::pi) : 0, kExact) << j;
  }
  // Y_00 is constant, and all bins have the same solid angle; Y_11 = sqrt(3 / 4 pi) x is odd in x.
  const std::vector<SweepBin> bins = sweep_bins(1);
  for (int b = 0; b < kSweepBins; ++b) {
    EXPECT_NEAR(projection(0, b), std::sqrt(std::numbers::pi) / 12, kExact) << b;
    EXPECT_GT(projection(3, b) * bins[static_cast<std::size_t>(b)].sign.x, 0) << b;
  }
}

TEST(Sweep, CoarserPartsContainFinerOnes) {
  EXPECT_EQ(coarser_part(3, 2, 2), 3);
  for (int part = 0; part < 9; ++part) EXPECT_EQ(coarser_part(part, 3, 1), 0);
  EXPECT_EQ(coarser_part(0, 4, 2), 0);
  EXPECT_EQ(coarser_part(3, 4, 2), 1);
  EXPECT_EQ(coarser_part(15, 4, 2), 3);
}

ClpvGrid grid_of(int n) {
  return cascade_grids(glm::vec3(0.5f), 1, n, n).front();  // cells of 1 m
}

/// Light of one cascade, by the CPU reference: `inject(bin, cell)` is the same in all channels.
reference::Volume swept(int n, int parts,
                        const std::function<double(int bin, const glm::ivec3&)>& inject,
                        const reference::Volume* geometry = nullptr) {
  const auto basis = make_basis("bins24");
  reference::Volume light(n, kSweepBins);
  reference::for_each_cell(n, [&](const glm::ivec3& p) {
    for (int bin = 0; bin < kSweepBins; ++bin) {
      for (int channel = 0; channel < 3; ++channel)
        light.at(channel, bin, p.x, p.y, p.z) = inject(bin, p);
    }
  });
  const SweptCascade cascade{grid_of(n), &light, geometry, parts};
  return reference::sweep(*basis, swept_by(*basis), {cascade}).front();
}

double fluence(const reference::Volume& light, const glm::ivec3& p) {
  double sum = 0;
  for (int bin = 0; bin < kSweepBins; ++bin)
    sum += std::numbers::pi / 6 * light.value(0, bin, p.x, p.y, p.z);
  return sum;
}

/// Fluence in the halo of cells at a distance `r` from the middle, relative to that of an isotropic
/// source of 1 W/sr: its mean and root mean square.
std::pair<double, double> halo(const reference::Volume& light, double r) {
  const int middle = light.n / 2;
  double sum = 0, squares = 0;
  int cells = 0;
  reference::for_each_cell(light.n, [&](const glm::ivec3& p) {
    const double distance = glm::length(glm::dvec3(p - middle));
    if (std::abs(distance - r) >= 0.5) return;
    const double share = fluence(light, p) * distance * distance;
    sum += share, squares += share * share, ++cells;
  });
  return {sum / cells, std::sqrt(squares / cells)};
}

TEST(Sweep, APointSourceFallsOffWithTheSquareOfItsDistance) {
  constexpr int kGrid = 31;
  const auto point = [](int, const glm::ivec3& p) {
    return p == glm::ivec3(kGrid / 2) ? 1.0 : 0.0;
  };
  double unevenness = 1e9;
  for (const int parts : {1, 2}) {
    const reference::Volume light = swept(kGrid, parts, point);
    for (const double r : {3.0, 6.0, 8.0, 12.0})
      EXPECT_NEAR(halo(light, r).first, 1, 0.12) << parts << ' ' << r;
    // Rays between few directions: the more of them, the more even.
    EXPECT_LT(halo(light, 12).second, 0.9 * unevenness);
    unevenness = halo(light, 12).second;
  }
}

TEST(Sweep, EveryPlaneCarriesAllLightUntilTheBorder) {
  constexpr int kGrid = 15, kMiddle = kGrid / 2;
  const auto point = [](int, const glm::ivec3& p) { return p == glm::ivec3(kMiddle) ? 2.0 : 0.0; };
  const reference::Volume light = swept(kGrid, 1, point);
  const std::vector<SweepBin> bins = sweep_bins(1);
  for (int b = 0; b < kSweepBins; ++b) {
    const SweepBin& bin = bins[static_cast<std::size_t>(b)];
    for (int plane = 0; plane < kGrid; ++plane) {
      double power = 0;
      for (int i = 0; i < kGrid * kGrid; ++i) {
        glm::ivec3 p;
        p[bin.axis] = plane, p[bin.u] = i % kGrid, p[bin.v] = i / kGrid;
        power += light.value(1, b, p.x, p.y, p.z) * bin.directions[0].flux;
      }
      const bool downstream = (plane - kMiddle) * bin.sign[bin.axis] >= 0;
      EXPECT_NEAR(power, downstream ? 2 : 0, kExact) << b << ' ' << plane;
    }
  }
}

// A wall blocks sum_a |k_a| / |k| of the light that passes it with offset k: all of it along its
// axis.
TEST(Sweep, AWallTransmitsThroughItsLinks) {
  constexpr int kGrid = 11, kWall = 6;
  for (const int distance : {1, 3}) {  // from the source on, the first cell's way included
    for (int axis = 0; axis < 3; ++axis) {
      reference::Volume geometry(kGrid + 1, 3, 1);
      for (int i = 0; i < (kGrid + 1) * (kGrid + 1); ++i) {
        glm::ivec3 p;
        p[axis] = kWall, p[(axis + 1) % 3] = i % (kGrid + 1), p[(axis + 2) % 3] = i / (kGrid + 1);
        geometry.at(0, axis, p.x, p.y, p.z) = 1;
      }
      const glm::ivec3 source =
          glm::ivec3(5) + (kWall - distance - 5) * glm::ivec3(axis == 0, axis == 1, axis == 2);
      const reference::Volume light = swept(
          kGrid, 1, [&](int, const glm::ivec3& p) { return p == source ? 1.0 : 0.0; }, &geometry);
      const std::vector<SweepBin> bins = sweep_bins(1);
      for (int b = 0; b < kSweepBins; ++b) {
        const SweepBin& bin = bins[static_cast<std::size_t>(b)];
        if (bin.axis != axis || bin.sign[axis] < 0) continue;
        double before = 0, behind = 0, open = 0;
        for (int i = 0; i < kGrid * kGrid; ++i) {
          glm::ivec3 p;
          p[bin.u] = i % kGrid, p[bin.v] = i / kGrid;
          p[axis] = kWall - 1, before += light.value(0, b, p.x, p.y, p.z);
          p[axis] = kWall, behind += light.value(0, b, p.x, p.y, p.z);
        }
        const SweepDirection& d = bin.directions[0];
        for (std::size_t k = 0; k < d.taps.size(); ++k)
          open += d.taps[k] * (1 - 1 / glm::length(glm::dvec3(bin.offset[k])));
        EXPECT_GT(before, 0.5) << axis << ' ' << b;
        EXPECT_NEAR(behind, open * before, kExact) << axis << ' ' << b;
      }
    }
  }
}

/// Injected light that makes the field uniform: each cell replaces the light that would come from
/// outside.
double made_up(int n, int b, const glm::ivec3& p) {
  static const std::vector<SweepBin> bins = sweep_bins(1);
  const SweepBin& bin = bins[static_cast<std::size_t>(b)];
  double outside = 0;
  for (std::size_t k = 0; k < bin.offset.size(); ++k) {
    const glm::ivec3 q = p - bin.offset[k];
    for (int axis = 0; axis < 3; ++axis) {
      if (q[axis] >= 0 && q[axis] < n) continue;
      outside += bin.directions[0].taps[k];
      break;
    }
  }
  return outside;
}

TEST(Sweep, UniformLightStaysSoThroughAllCascades) {
  constexpr int kGrid = 10;
  const std::vector<SweepBin> bins = sweep_bins(1);
  const auto basis = make_basis("bins24");
  const std::vector<int> parts{2, 1, 1};
  const auto grids = cascade_grids({0.3f, 1.1f, -0.6f}, 3, 5, kGrid);
  reference::Volume dark(kGrid, kSweepBins), uniform(kGrid, kSweepBins);
  reference::for_each_cell(kGrid, [&](const glm::ivec3& p) {
    for (int b = 0; b < kSweepBins; ++b) {
      for (int channel = 0; channel < 3; ++channel)
        uniform.at(channel, b, p.x, p.y, p.z) = (1 + channel) * made_up(kGrid, b, p);
    }
  });
  std::vector<SweptCascade> cascades;
  for (std::size_t c = 0; c < grids.size(); ++c)
    cascades.push_back({grids[c], c == 2 ? &uniform : &dark, nullptr, parts[c]});
  const auto expected = reference::sweep(*basis, swept_by(*basis), cascades);

  const std::size_t cells = kGrid * kGrid * kGrid;
  for (std::size_t c = 0; c < grids.size(); ++c) {
    for (std::size_t i = 0; i < expected[c].values.size(); ++i) {
      const std::size_t plane = i / cells;
      const double wanted = (1 + static_cast<double>(plane / kSweepBins)) *
                            std::pow(4.0, static_cast<double>(c) - 2) /
                            bins[plane % kSweepBins].directions[0].flux;
      ASSERT_NEAR(expected[c].values[i], wanted, kFloat * wanted) << c << ' ' << i;
    }
  }
}

/// A square of 0.3 m on the floor emits 1 W/m^2 by a clamped cosine, held in harmonics. Fluence
/// [W/m^2] on a ceiling 0.56 m above and on a wall 0.34 m beside its middle, against the integral
/// over the square.
struct SquareErrors {
  double ceiling, wall;  ///< root mean square, relative
  double energy;         ///< on the ceiling, relative
};
SquareErrors square_errors(const char* name, int parts, int cells_across) {
  const auto basis = make_basis(name);
  const double s = 0.3 / cells_across;
  const int n = static_cast<int>(0.76 / s);
  const glm::ivec3 first((n - cells_across) / 2, (n - cells_across) / 2, 0);
  std::vector<double> intensity = basis->clamped_cosine({0, 0, 1});
  for (double& c : intensity) c *= s * s / std::numbers::pi;
  reference::Volume light(n, basis->size());
  for (int i = 0; i < cells_across * cells_across; ++i)
    light.set_cell(0, first + glm::ivec3(i % cells_across, i / cells_across, 0), intensity);
  ClpvGrid grid = grid_of(n);
  grid.cell = static_cast<float>(s);
  const SweptCascade cascade{grid, &light, nullptr, parts};
  const reference::Volume swept = reference::sweep(*basis, swept_by(*basis), {cascade}).front();
  const auto exact = [&](const glm::ivec3& p) {
    constexpr int kSamples = 18;  // along each edge of the square
    double sum = 0;
    for (int j = 0; j < kSamples * kSamples; ++j) {
      const glm::dvec3 from((first.x - 0.5 + (j % kSamples + 0.5) * cells_across / kSamples) * s,
                            (first.y - 0.5 + (j / kSamples + 0.5) * cells_across / kSamples) * s,
                            0);
      const glm::dvec3 way = glm::dvec3(p) * s - from;
      sum += std::max(0.0, glm::normalize(way).z) / std::numbers::pi / glm::dot(way, way);
    }
    return sum * 0.3 * 0.3 / (kSamples * kSamples);
  };
  double errors[2] = {0, 0}, squares[2] = {0, 0}, energy = 0, exact_energy = 0;
  for (int i = 0; i < n * n; ++i) {
    const int u = i % n, v = i / n;
    const glm::ivec3 points[2] = {{u, v, static_cast<int>(0.56 / s)},
                                  {n / 2 + static_cast<int>(0.34 / s), u, v}};
    for (int side = 0; side < 2; ++side) {
      const double found = fluence(swept, points[side]) / (s * s), wanted = exact(points[side]);
      errors[side] += (found - wanted) * (found - wanted), squares[side] += wanted * wanted;
      if (side == 0) energy += found, exact_energy += wanted;
    }
  }
  return {std::sqrt(errors[0] / squares[0]), std::sqrt(errors[1] / squares[1]),
          energy / exact_energy};
}

TEST_P(EachPartition, WhatHarmonicsLackMakesAClampedCosine) {
  const glm::dvec3 n = glm::normalize(glm::dvec3(-2, 1, -3));
  const std::vector<SweepBin> bins = sweep_bins(GetParam());
  const Matrix directions = part_means(*make_basis("sh2"), GetParam());
  for (const char* name : {"sh2", "sh3", "sh4", "sh5"}) {
    const auto basis = make_basis(name);
    const Matrix means = part_means(*basis, GetParam());
    const auto [e0, e2, e4] = cosine_rest(*basis, means, GetParam()).value().even;
    const std::vector<double> c = basis->clamped_cosine(n);
    double energy = 0, error = 0;
    for (int d = 0; d < means.rows(); ++d) {
      const glm::dvec3 w = glm::dvec3(directions(d, 3), directions(d, 1), directions(d, 2)) /
                           std::sqrt(3 / (4 * std::numbers::pi));
      const double z = glm::dot(w, n),
                   rest = std::abs(z) / 2 - e0 - e2 * z * z - e4 * z * z * z * z;
      double light = rest;
      for (int i = 0; i < basis->size(); ++i) light += c[i] * means(d, i);
      const int parts = GetParam() * GetParam();
      const double solid_angle = bins[d / parts].directions[d % parts].solid_angle;
      energy += solid_angle * light;
      error += solid_angle * std::pow(light - std::max(0.0, z), 2);
    }
    // 24 directions integrate less exactly than 96 and 216.
    EXPECT_NEAR(energy, std::numbers::pi, GetParam() == 1 ? 0.025 : 0.02) << name;
    EXPECT_LT(std::sqrt(error / (2 * std::numbers::pi / 3)), GetParam() == 1 ? 0.06 : 0.02) << name;
  }
  const auto other = make_basis("srbf8v2");
  EXPECT_FALSE(cosine_rest(*other, part_means(*other, GetParam()), GetParam()));
}

void expect_near_the_square(const SquareErrors& errors) {
  EXPECT_NEAR(errors.energy, 1, 0.025);
  EXPECT_LT(errors.ceiling, 0.06);
}

TEST(Sweep, ASquareIsNearItsClosedForm) {
  expect_near_the_square(square_errors("sh2", 4, 10));
}

TEST(LongSweep, ASquareConvergesToItsClosedForm) {
  const SquareErrors coarse = square_errors("sh2", 4, 10), fine = square_errors("sh2", 4, 18);
  expect_near_the_square(fine);
  EXPECT_LT(fine.wall, 0.8 * coarse.wall);
}

TEST(Sweep, PlansHaveTheSweepsOfTheMethod) {
  EXPECT_EQ(sweep_plan(Bounces::one, true, 3).size(), 1);
  EXPECT_EQ(sweep_plan(Bounces::two, false, 3).size(), 2);
  EXPECT_EQ(sweep_plan(Bounces::two, true, 3).size(), 2);
  EXPECT_EQ(sweep_plan(Bounces::all, false, 3).size(), 4);
  EXPECT_EQ(sweep_plan(Bounces::all, true, 3).size(), 9);
}

TEST(Sweep, RejectsGridsThatAreNotNested) {
  const auto basis = make_basis("bins24");
  Sweeper sweeper(test_session(), *basis, swept_by(*basis),
                  {.grid = 6, .parts = {1, 1}, .blocking = false});
  Volume light(test_session(), {6, kSweepBins, 3}, "test: light");
  const auto grids = cascade_grids(glm::vec3(0), 3, 3, 6);
  EXPECT_THROW(sweeper.sweep({1, {grids[0], grids[2]}, light}, light), Error);
}

TEST(Sweep, RejectsVolumesThatKernelsCannotAddress) {
  const SweepVolumes volumes(test_session(), 512, {Layout::soa, Storage::float16});
  EXPECT_THAT([&] { volumes.make(3 * kSweepBins, "light to sweep"); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("light to sweep of 9")));
}

TEST(Sweep, IsNoMatterOfSteps) {
  const auto basis = make_basis("sh2");
  EXPECT_THROW(Propagator(test_session(), *basis, swept_by(*basis), {.grid = 4}), Error);
}

}  // namespace clpv::sweep_test
