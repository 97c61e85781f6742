// SPDX-License-Identifier: MIT
// Error measures on images with known errors, and the command `clpv compare`.

#include "image/compare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::compare_test {

/// Every pixel (r, g, b, 1).
Image plain(int width, int height, float r, float g, float b) {
  Image image = make_image(width, height, {"R", "G", "B", "A"});
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    image.pixels[4 * p] = r;
    image.pixels[4 * p + 1] = g;
    image.pixels[4 * p + 2] = b;
    image.pixels[4 * p + 3] = 1;
  }
  return image;
}

std::string rejection(const Image& a, const Image& b) {
  return test::error_of(ExitCode::bad_input, [&] { compare(a, "a.exr", b, "b.exr"); });
}

TEST(Compare, IdenticalImages) {
  const Image image = plain(64, 48, 0.2f, 0.4f, 0.1f);
  const Comparison c = compare(image, "a", image, "b");
  EXPECT_TRUE(c.identical);
  EXPECT_EQ(c.rmse, 0);
  EXPECT_EQ(c.nrmse.value(), 0);
  EXPECT_EQ(c.relative_mse, 0);
  EXPECT_FALSE(c.psnr_db.has_value());
  EXPECT_EQ(c.channels, 3);
  EXPECT_EQ(c.nrmse_best_gain.value(), 0);
  EXPECT_NEAR(c.energy_ratio.value(), 1, 1e-12);
  EXPECT_EQ(c.flip.value(), 0);
  EXPECT_EQ(c.valid_pixels, 64u * 48u);
  EXPECT_TRUE(to_json(c)["psnr_db"].is_null());
  EXPECT_EQ(to_json(c)["schema"], 1);
}

TEST(Compare, AConstantOffset) {
  const Comparison c =
      compare(plain(8, 8, 0.75f, 0.75f, 0.75f), "a", plain(8, 8, 0.5f, 0.5f, 0.5f), "b");
  EXPECT_FALSE(c.identical);
  EXPECT_NEAR(c.rmse, 0.25, 1e-12);
  EXPECT_NEAR(c.nrmse.value(), 0.5, 1e-12);
  EXPECT_NEAR(c.relative_mse, 0.0625 / 0.26, 1e-12);
  EXPECT_NEAR(c.psnr_db.value(), 20 * std::log10(4.0), 1e-9);
  EXPECT_NEAR(c.mean_luminance[0], 0.75, 1e-6);
  EXPECT_NEAR(c.mean_luminance[1], 0.5, 1e-6);
  EXPECT_NEAR(c.best_gain.value(), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(c.nrmse_best_gain.value(), 0, 1e-7);
  EXPECT_NEAR(c.energy_ratio.value(), 1.5, 1e-12);
}

TEST(Compare, AlphaIsNotComparedButMarksValidPixels) {
  Image a = plain(4, 2, 1, 1, 1), b = plain(4, 2, 2, 2, 2);
  for (int y = 0; y < 2; ++y) {
    a.at(0, y, 3) = 0;  // background in A only, where A is bright
    a.at(0, y, 0) = 100;
    b.at(1, y, 3) = 0;
  }
  const Comparison c = compare(a, "a", b, "b");
  EXPECT_EQ(c.valid_pixels, 4u);
  EXPECT_NEAR(c.nrmse_valid.value(), 0.5, 1e-12);
  EXPECT_NEAR(c.best_gain.value(), 2, 1e-12);
  EXPECT_NEAR(c.energy_ratio.value(), 0.5, 1e-12);
  EXPECT_GT(c.max_error, 90);

  Image clear = b;
  for (std::size_t p = 0; p < clear.pixel_count(); ++p) clear.pixels[4 * p + 3] = 0.5f;
  EXPECT_TRUE(compare(clear, "a", b, "b").identical);
}

TEST(Compare, ABlackReferenceHasNoRelativeError) {
  const Comparison c = compare(plain(2, 2, 1, 1, 1), "a", plain(2, 2, 0, 0, 0), "b");
  EXPECT_FALSE(c.nrmse.has_value());
  EXPECT_FALSE(c.energy_ratio.has_value());
  EXPECT_NEAR(c.relative_mse, 100, 1e-9);
  const Comparison black = compare(plain(2, 2, 0, 0, 0), "a", plain(2, 2, 0, 0, 0), "b");
  EXPECT_EQ(black.nrmse.value(), 0);
  EXPECT_TRUE(black.identical);
}

TEST(Compare, RejectsWhatCannotBeCompared) {
  const Image image = plain(4, 4, 1, 1, 1);
  EXPECT_NE(rejection(image, plain(4, 5, 1, 1, 1)).find("4 x 5"), std::string::npos);
  EXPECT_NE(rejection(image, make_image(4, 4, {"Y"})).find("1"), std::string::npos);
  for (const float value : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    Image bad = image;
    bad.at(2, 1, 1) = value;
    const std::string message = rejection(image, bad);
    EXPECT_NE(message.find("b.exr: pixel (2, 1), channel G"), std::string::npos) << message;
    rejection(bad, bad);  // a NaN in both is no agreement
  }
  Image encoded = image;
  encoded.encoding = Encoding::srgb;
  EXPECT_NE(rejection(image, encoded).find("b.exr sRGB"), std::string::npos);
}

struct CompareCommand : ::testing::Test {
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  /// Runs `clpv compare` and returns its exit code.
  int run(const std::string& arguments) {
    outcome_ = test::run_here("compare " + arguments);
    return outcome_.exit_code;
  }
  nlohmann::json output() const { return nlohmann::json::parse(outcome_.out); }

  test::TemporaryFolder folder_;
  test::Outcome outcome_;
};

TEST_F(CompareCommand, ComparesALayerAndWritesTheDifference) {
  Image a, b;
  append_layer(a, plain(6, 4, 0.5f, 0.5f, 0.5f), "");
  append_layer(a, plain(6, 4, 0.21f, 0.2f, 0.2f), "indirect");
  append_layer(b, plain(6, 4, 0.5f, 0.5f, 0.5f), "");
  append_layer(b, plain(6, 4, 0.2f, 0.2f, 0.2f), "indirect");
  write_exr(file("a.exr"), a);
  write_exr(file("b.exr"), b);
  ASSERT_EQ(run(file("a.exr") + " " + file("b.exr")), 0);
  EXPECT_TRUE(output()["identical"].get<bool>());
  ASSERT_EQ(run(file("a.exr") + " " + file("b.exr") + " --layer indirect -o " + file("d.exr") +
                " --amplify 10"),
            0);
  EXPECT_NEAR(output()["max_error"].get<double>(), 0.01, 1e-6);
  EXPECT_NEAR(read_image(file("d.exr")).at(0, 0, 0), 0.1f, 1e-5);
  ASSERT_EQ(run(file("a.exr") + " " + file("b.exr") + " --layer indirect -o " + file("d.png")), 0);
  EXPECT_GT(read_image(file("d.png")).width, 3 * 6) << "both images, their difference, a scale";
  EXPECT_EQ(run(file("a.exr") + " " + file("b.exr") + " --layer direct"), 3);
  write_exr(file("c.exr"), plain(6, 4, 0.2f, 0.2f, 0.2f));
  ASSERT_EQ(run(file("a.exr") + ":indirect " + file("c.exr")), 0);
  EXPECT_NEAR(output()["max_error"].get<double>(), 0.01, 1e-6);
  ASSERT_EQ(run(file("c.exr") + " " + file("b.exr") + ":indirect"), 0);
  EXPECT_TRUE(output()["identical"].get<bool>());
  EXPECT_EQ(run(file("a.exr") + ":direct " + file("c.exr")), 3);
}

// It once printed nulls and ended with 0.
TEST_F(CompareCommand, ImagesWithoutACommonValidPixelFail) {
  Image left = plain(2, 1, 1, 1, 1), right = left;
  left.at(0, 0, 3) = right.at(1, 0, 3) = 0;
  write_exr(file("a.exr"), left);
  write_exr(file("b.exr"), right);
  EXPECT_EQ(run(file("a.exr") + " " + file("b.exr")), 5);
  EXPECT_THAT(outcome_.err, testing::HasSubstr("b.exr: found no pixel with alpha above 0 in both"));
  EXPECT_EQ(output()["valid_pixels"], 0);
  EXPECT_EQ(run(file("a.exr") + " " + file("a.exr")), 0);
}

// FLIP: properties, and values of the authors' implementation (PyPI package flip-evaluator 1.7).
// tests/flip/check_package compares more images, where the package is installed.

Image drawn(int width, int height, const std::function<glm::vec3(int, int)>& colour) {
  Image image = make_image(width, height, {"R", "G", "B"});
  image.encoding = Encoding::srgb;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec3 value = colour(x, y);
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = value[c];
    }
  }
  return image;
}

Image plain(const glm::vec3& colour) {
  return drawn(32, 24, [&](int, int) { return colour; });
}

using test::mean;

TEST(Flip, PlainColours) {
  EXPECT_EQ(mean(flip(plain({0.2f, 0.5f, 0.7f}), plain({0.2f, 0.5f, 0.7f}))), 0);
  EXPECT_NEAR(mean(flip(plain(glm::vec3(0)), plain(glm::vec3(1)))), 0.96739, 1e-4);
  EXPECT_NEAR(mean(flip(plain({0, 1, 0}), plain({0, 0, 1}))), 1, 1e-6) << "the largest difference";
  EXPECT_NEAR(mean(flip(plain({1, 0, 0}), plain({0, 1, 0}))), 0.98667, 1e-4);
  EXPECT_NEAR(mean(flip(plain(glm::vec3(0.5f)), plain(glm::vec3(0.6f)))), 0.28506, 1e-4);
}

TEST(Flip, StripesAndEdges) {
  const auto stripes = [](int period) {
    return drawn(64, 48,
                 [=](int x, int) { return glm::vec3(x % period < period / 2 ? 0.25f : 0.75f); });
  };
  const Image grey = drawn(64, 48, [](int, int) { return glm::vec3(0.5f); });
  EXPECT_NEAR(mean(flip(stripes(2), grey)), 0.26794, 1e-4);
  EXPECT_NEAR(mean(flip(stripes(16), grey)), 0.66732, 1e-4);
  const auto edge = [](int at, float blue) {
    return drawn(64, 48, [=](int x, int y) {
      return x + y < at ? glm::vec3(0.8f, 0.6f, blue) : glm::vec3(0.1f, 0.2f, 0.3f);
    });
  };
  EXPECT_NEAR(mean(flip(edge(50, 0.2f), edge(53, 0.25f))), 0.15884, 1e-4);
}

TEST(Flip, FinerPixelsAreSeenLess) {
  const Image stripes =
      drawn(64, 48, [](int x, int) { return glm::vec3(x % 8 < 4 ? 0.25f : 0.75f); });
  const Image grey = drawn(64, 48, [](int, int) { return glm::vec3(0.5f); });
  EXPECT_LT(mean(flip(stripes, grey, 200)), 0.8 * mean(flip(stripes, grey)));
}

}  // namespace clpv::compare_test
