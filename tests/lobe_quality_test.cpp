// SPDX-License-Identifier: MIT
// What clpv basis tells of a lobe, against quadrature and a finer search; its energies against the tabled ones.
#include "basis/lobe_quality.hpp"

#include <gtest/gtest.h>

#include "tests/support/sphere_quadrature.hpp"

namespace clpv::lobe_quality_test {
namespace {

const glm::dvec3 kOblique = glm::normalize(glm::dvec3(-2, 1, -3));

TEST(LobeQuality, OfSh2IsKnownInClosedForm) {
  // 1/4 + 1/2 cos: least -1/4, flux pi, peak along the axis; |max(0,t)|^2 - |fit|^2 = 2 pi/3 - 7 pi/12.
  const auto basis = make_basis("sh2");
  const LobeQuality quality = lobe_quality(*basis, basis->clamped_cosine(kOblique), kOblique);
  EXPECT_NEAR(quality.minimum, -0.25, 1e-12);
  EXPECT_NEAR(quality.flux, std::numbers::pi, 1e-12);
  EXPECT_NEAR(quality.peak_error_degrees, 0, 1e-4);
  EXPECT_NEAR(quality.relative_l2, std::sqrt(1.0 / 8), 1e-12);
}

TEST(LobeQuality, OfAnSrbfLobePointByPoint) {
  const auto basis = make_basis("srbf8v2");
  const std::vector<double> c = basis->clamped_cosine(kOblique);
  const LobeQuality quality = lobe_quality(*basis, c, kOblique);
  const auto nodes = test::sphere(kOblique);
  const double squared = test::integral(nodes, [&](const glm::dvec3& w) {
    const double difference = basis->value(c, w) - std::max(0.0, glm::dot(w, kOblique));
    return difference * difference;
  });
  EXPECT_NEAR(quality.relative_l2, std::sqrt(squared / (2 * std::numbers::pi / 3)), 1e-9);
  double least = 0, most = 0;
  for (const glm::dvec3& w : test::spread_axes(20000)) {
    least = std::min(least, basis->value(c, w));
    most = std::max(most, basis->value(c, w));
  }
  EXPECT_LE(quality.minimum, least + 1e-12);
  EXPECT_NEAR(quality.minimum, least, 1e-3);
  // Some direction at that distance from the axis is as high as the highest.
  double highest = 0;
  const auto [u, v] = test::across(kOblique);
  const double tilt = quality.peak_error_degrees * std::numbers::pi / 180;
  for (int i = 0; i < 720; ++i) {
    const double phi = i * std::numbers::pi / 360;
    highest =
        std::max(highest, basis->value(c, std::cos(tilt) * kOblique +
                                              std::sin(tilt) * (std::cos(phi) * u + std::sin(phi) * v)));
  }
  EXPECT_NEAR(highest, most, 1e-3);
}

TEST(MeanError, IsAsTabled) {
  const auto mean = [](const char* name, LobeKind kind) {
    const auto basis = make_basis(name);
    return mean_relative_l2(*basis, Lobes(*basis, {.kind = kind, .table_size = 0}));
  };
  EXPECT_NEAR(mean("sh2", LobeKind::exact), std::sqrt(1.0 / 8), 1e-9) << "the same along every axis";
  EXPECT_NEAR(mean("srbf4", LobeKind::exact), .399, .003);
  EXPECT_NEAR(mean("srbf8v2", LobeKind::exact), .231, .003);
  EXPECT_NEAR(mean("srbf8v2", LobeKind::rotate), .357, .003);
  EXPECT_NEAR(mean("srbf14", LobeKind::rotate), .089, .003);
}

TEST(EnergyAfter, IsAsTabled) {
  const auto basis = make_basis("srbf14");
  const Transport sampled = make_transport(TransportKind::sampled, *basis),
                  exact = make_transport(TransportKind::exact, *basis);
  EXPECT_NEAR(energy_after(*basis, std::get<FaceTransport>(sampled.scheme), 8), .565, 5.1e-4);
  EXPECT_NEAR(energy_after(*basis, std::get<FaceTransport>(sampled.scheme), 24), .153, 5.1e-4);
  EXPECT_NEAR(energy_after(*basis, std::get<FaceTransport>(exact.scheme), 24), 1, 1e-13);
}

}  // namespace
}  // namespace clpv::lobe_quality_test
