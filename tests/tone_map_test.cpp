// SPDX-License-Identifier: MIT
// Tone curves and the sRGB encoding against published values and closed forms.
#include "image/tone_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace clpv::tone_map_test {
namespace {

TEST(Srgb, PublishedValues) {
  // IEC 61966-2-1: the joint of its two pieces, and 18 % grey and .5 as tabled everywhere.
  EXPECT_FLOAT_EQ(srgb_encode(0), 0);
  EXPECT_NEAR(srgb_encode(1), 1, 1e-6);
  EXPECT_NEAR(srgb_encode(0.0031308f), 0.040449936f, 1e-6);
  EXPECT_NEAR(srgb_encode(0.18f) * 255, 117.6f, 0.1f);
  EXPECT_NEAR(srgb_encode(0.21404114f), 0.5f, 1e-5);
  EXPECT_NEAR(srgb_encode(0.5f) * 255, 187.5f, 0.1f);
}

TEST(Srgb, DecodeUndoesEncode) {
  for (int i = 0; i <= 255; ++i) {
    const float value = i / 255.0f;
    EXPECT_NEAR(srgb_encode(srgb_decode(value)), value, 1e-5) << i;
  }
}

TEST(ToneCurve, NoneClamps) {
  EXPECT_EQ(tone_curve(ToneMap::none, {0.25f, -1, 3}), glm::vec3(0.25f, 0, 1));
}

TEST(ToneCurve, ReinhardOnGreyAndOnColour) {
  EXPECT_NEAR(tone_curve(ToneMap::reinhard, glm::vec3(1)).g, 0.5f, 1e-6);
  EXPECT_NEAR(tone_curve(ToneMap::reinhard, glm::vec3(3)).g, 0.75f, 1e-6);
  const glm::vec3 colour(0.2f, 0.4f, 0.1f), shown = tone_curve(ToneMap::reinhard, colour);
  const float y = luminance(colour);
  EXPECT_NEAR(luminance(shown), y / (1 + y), 1e-6);
  EXPECT_NEAR(shown.r / shown.g, colour.r / colour.g, 1e-5);
}

TEST(ToneCurve, AcesFit) {
  EXPECT_EQ(tone_curve(ToneMap::aces, glm::vec3(0)), glm::vec3(0));
  // (2.51 + .03) / (2.43 + .59 + .14), and white where x(2.51x+.03) = x(2.43x+.59)+.14: .08 x^2 - .56 x - .14
  // = 0.
  EXPECT_NEAR(tone_curve(ToneMap::aces, glm::vec3(1)).r, 2.54f / 3.16f, 1e-6);
  EXPECT_NEAR(tone_curve(ToneMap::aces, glm::vec3(0.18f)).r, 0.2669f, 1e-4);
  const float white = (0.56f + std::sqrt(0.56f * 0.56f + 4 * 0.08f * 0.14f)) / 0.16f;
  EXPECT_LT(tone_curve(ToneMap::aces, glm::vec3(white * 0.99f)).r, 1.0f);
  EXPECT_EQ(tone_curve(ToneMap::aces, glm::vec3(white * 1.01f)).r, 1.0f);
}

TEST(ToneCurve, RisesAndStaysInRange) {
  for (const ToneMap curve : {ToneMap::none, ToneMap::reinhard, ToneMap::aces}) {
    float before = 0;
    for (float x = 1e-4f; x < 1e30f; x *= 1.5f) {
      const float shown = tone_curve(curve, glm::vec3(x)).g;
      EXPECT_GE(shown, before) << name_of(curve) << " at " << x;
      EXPECT_LE(shown, 1.0f);
      before = shown;
    }
    EXPECT_GT(before, 0.99f);
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_GT(tone_curve(curve, glm::vec3(infinity)).g, 0.99f);
  }
}

TEST(DisplayImage, ExposureDoublesAndBackgroundStaysClear) {
  Image image = make_image(2, 1, {"R", "G", "B", "A"});
  image.pixels = {0.1f, 0.2f, 0.3f, 1, 5, 5, 5, 0};
  const Image shown = display_image(image, 1, ToneMap::none);
  EXPECT_EQ(shown.encoding, Encoding::srgb);
  EXPECT_NEAR(shown.at(0, 0, 0), srgb_encode(0.2f), 1e-6);
  EXPECT_NEAR(shown.at(0, 0, 2), srgb_encode(0.6f), 1e-6);
  EXPECT_EQ(shown.at(0, 0, 3), 1.0f);
  for (int c = 0; c < 4; ++c) EXPECT_EQ(shown.at(1, 0, c), 0.0f);
}

}  // namespace
}  // namespace clpv::tone_map_test
