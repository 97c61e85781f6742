// SPDX-License-Identifier: MIT
// Formats of light probes against closed forms, and their textures looked up as engines do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "bake/bake.hpp"
#include "bake/ktx2.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/ktx2_reader.hpp"
#include "tests/support/sphere_quadrature.hpp"

namespace clpv::probe_formats_test {
using namespace bake;
using namespace test;
using std::numbers::pi;

using Radiance = std::function<double(const glm::dvec3& w)>;

/// Coefficients of a radiance that is smooth in octants about `axis`.
std::vector<glm::dvec3> projected(const ProbeFormat& format, const Radiance& radiance,
                                  const glm::dvec3& axis = {0, 0, 1}) {
  std::vector<double> g(format.moments.count);
  std::vector<glm::dvec3> integrals(g.size(), glm::dvec3(0));
  for (const Node& node : sphere(axis)) {
    format.moments.weights(node.w, g);
    for (std::size_t i = 0; i < g.size(); ++i)
      integrals[i] += node.weight * g[i] * radiance(node.w);
  }
  return format.encoded(integrals);
}

/// Coefficients of an irradiance of 1 from one direction.
std::vector<glm::dvec3> of_direction(const ProbeFormat& format, const glm::dvec3& d) {
  std::vector<double> g(format.moments.count);
  format.moments.weights(d, g);
  std::vector<glm::dvec3> integrals;
  for (const double value : g) integrals.emplace_back(value);
  return format.encoded(integrals);
}

const glm::dvec3 kTilted = glm::normalize(glm::dvec3(2, 3, -1));

// Radiance 1 from everywhere: irradiance pi on every surface.
TEST(ProbeFormats, Furnace) {
  for (const std::string& name : probe_format_names()) {
    const ProbeFormat format = probe_format(name);
    const auto c = projected(format, [](const glm::dvec3&) { return 1.0; });
    EXPECT_EQ(c.size(), format.size) << name;
    const bool srbf = name.starts_with("srbf");  // which have no constant
    for (const glm::dvec3& n : probe_normals().normals)
      EXPECT_NEAR(format.irradiance(c, n).x, pi, (srbf ? 0.06 : 4e-3) * pi) << name;
    EXPECT_EQ(negative_share(format, c), 0) << name;
  }
}

// Irradiance on surfaces across one direction and away from it.
TEST(ProbeFormats, OneDirection) {
  const std::map<std::string, std::pair<double, double>> wanted{{"sh2", {0.75, -0.25}},
                                                                {"sh2-geomerics", {1, 0}},
                                                                {"zh3", {1.0625, 0.0625}},
                                                                {"sh3", {1.0625, 0.0625}}};
  for (const auto& [name, towards] : wanted) {
    const ProbeFormat format = probe_format(name);
    const auto c = of_direction(format, kTilted);
    EXPECT_NEAR(format.irradiance(c, kTilted).x, towards.first, 1e-9) << name;
    EXPECT_NEAR(format.irradiance(c, -kTilted).x, towards.second, 1e-9) << name;
  }
  const ProbeFormat fit = probe_format("ambient-cube");
  EXPECT_NEAR(fit.irradiance(of_direction(fit, kTilted), kTilted).x,
              fit.irradiance(of_direction(fit, -kTilted), -kTilted).x, 1e-9)
      << "the cube is symmetric";
  const ProbeFormat means = probe_format("ambient-cube-mean");
  const auto cube = of_direction(means, {0, -1, 0});
  EXPECT_NEAR(means.irradiance(cube, {0, -1, 0}).x, 1, 1e-12);
  EXPECT_EQ(means.irradiance(cube, {0, 1, 0}).x, 0);
  // Every format is as bright on average as the light: 1 / 4.
  for (const std::string& name : probe_format_names()) {
    const ProbeFormat format = probe_format(name);
    const auto c = of_direction(format, kTilted);
    double sum = 0;
    for (std::size_t k = 0; k < probe_normals().normals.size(); ++k)
      sum += probe_normals().weights[k] * format.irradiance(c, probe_normals().normals[k]).x;
    const bool exact = name.starts_with("sh") || name == "zh3" || name == "ambient-cube";
    EXPECT_NEAR(sum / (4 * pi), 0.25, exact ? 3e-3 : 0.06) << name;
  }
}

TEST(ProbeFormats, NegativeLightIsCounted) {
  const auto share = [](const char* name) {
    const ProbeFormat format = probe_format(name);
    return negative_share(format, of_direction(format, kTilted));
  };
  EXPECT_NEAR(share("sh2"), 0.25, 0.03) << "cosines below -1/2";
  EXPECT_GT(share("sh3"), 0);
  for (const char* name : {"sh2-geomerics", "sh3-windowed", "ambient-cube-mean"})
    EXPECT_EQ(share(name), 0) << name;
}

TEST(ProbeFormats, IntegralsOfHarmonics) {
  const Matrix identity = of_harmonics(probe_format("sh3"));
  const Matrix means = of_harmonics(probe_format("ambient-cube-mean"));
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) EXPECT_NEAR(identity(i, j), i == j, 1e-6);
  for (int face = 0; face < 6; ++face) {
    EXPECT_NEAR(means(face, 0), std::sqrt(1 / (4 * pi)), 1e-6);
    EXPECT_NEAR(means(face, 3), (face == 0 ? 1 : face == 1 ? -1 : 0) * 2 / 3.0 * 0.4886025, 1e-6);
  }
}

TEST(Half, IsTheNearest) {
  for (int bits = 0; bits < 0x7c00; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const float value = number_of_half(half), next = number_of_half(half + 1);
    ASSERT_EQ(half_of(value), half);
    ASSERT_EQ(half_of(-value), half | 0x8000);
    if (bits == 0x7bff) break;
    const float middle = value + (next - value) / 2;
    ASSERT_EQ(half_of(middle), bits % 2 == 0 ? half : half + 1) << "a tie goes to even";
    ASSERT_EQ(half_of(std::nextafter(middle, value)), half);
    ASSERT_EQ(half_of(std::nextafter(middle, next)), half + 1);
  }
  EXPECT_EQ(half_of(65519.99f), 0x7bff);
  EXPECT_EQ(half_of(65520), 0x7c00);
}

/// Probes with the given light at each position.
BakedProbes probes_of(const ProbeFormat& format, const ProbeGrid& grid,
                      const std::function<Radiance(const glm::dvec3& position)>& light) {
  BakedProbes baked{grid, {}, std::vector<std::uint8_t>(grid.size(), 1), true, 0};
  for (std::size_t i = 0; i < grid.size(); ++i)
    for (const glm::dvec3& c : projected(format, light(grid.position(i))))
      baked.coefficients.emplace_back(c);
  return baked;
}

const ProbeGrid kGrid{{3, 4, 2}, {-1, 0, 2}, {1, 3, 4}};

TEST(Ktx2, LightBeyondHalvesIsScaled) {
  const ProbeFormat format = probe_format("ambient-cube-mean");
  for (const double light : {1.0, 1e6, 3e-5, 0.0, 1e-35, 1e-38, 1e38}) {
    const BakedProbes baked = probes_of(
        format, kGrid, [&](const auto&) { return [&](const glm::dvec3&) { return light; }; });
    const double intensity = intensity_of(baked);
    EXPECT_EQ(std::log2(intensity), std::round(std::log2(intensity)));
    EXPECT_EQ(intensity == 1, light == 0 || light == 1);
    const ReadTexture read = read_ktx2(ktx2_bytes(texture_of(format, baked, intensity), "test"));
    for (const glm::vec4& texel : read.texels) {
      EXPECT_NEAR(double{texel.x} * intensity, double{static_cast<float>(light)}, 1e-3 * light);
      EXPECT_EQ(texel.w, 1);
    }
  }
}

}  // namespace clpv::probe_formats_test
