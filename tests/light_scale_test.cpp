// SPDX-License-Identifier: MIT
// Light as volumes of 16 bits hold it: neither lux nor candle light leaves their range.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipeline/frame_lights.hpp"
#include "tests/support/scene_builder.hpp"

namespace clpv::light_scale_test {
namespace {

constexpr VolumeFormat kHalf{Layout::soa, Storage::float16};

TEST(LightScale, FloatsAreLeftAlone) {
  EXPECT_EQ(light_scale({}, {test::directional_light({0, -1, 0}, glm::vec3(1e5f))}, 1), 1);
}

TEST(LightScale, NothingToScaleWithoutLight) {
  EXPECT_EQ(light_scale(kHalf, {}, 1), 1);
  EXPECT_EQ(light_scale(kHalf, {test::directional_light({0, -1, 0}, glm::vec3(0))}, 1), 1);
}

TEST(LightScale, AFullCellIsAThousandthOfTheRange) {
  for (const float irradiance : {1e-6f, 1.0f, 1e5f}) {
    for (const float cell : {0.1f, 3.0f}) {
      const float scale =
          light_scale(kHalf, {test::directional_light({0, -1, 0}, glm::vec3(irradiance))}, cell);
      const double full = static_cast<double>(irradiance) * cell * cell / std::numbers::pi * scale;
      EXPECT_GT(full, 128) << irradiance << " W/m^2, " << cell << " m";
      EXPECT_LE(full, 257) << irradiance << " W/m^2, " << cell << " m";
      int exponent = 0;
      EXPECT_EQ(std::frexp(scale, &exponent), 0.5f) << "scaling rounds nothing";
    }
  }
}

TEST(LightScale, LampsCountWithAllTheySend) {
  const float scale = light_scale(kHalf, {test::point_light({0, 1, 0}, glm::vec3(100))}, 0.4f);
  EXPECT_LE(100 * 4 * scale, 257);
}

TEST(LightScale, ScalesEveryColour) {
  const ClpvLight twice = scaled(test::directional_light({0, -1, 0}, {1, 2, 3}), 2);
  EXPECT_EQ(twice.intensity[0], 2);
  EXPECT_EQ(twice.intensity[1], 4);
  EXPECT_EQ(twice.intensity[2], 6);
}

}  // namespace
}  // namespace clpv::light_scale_test
