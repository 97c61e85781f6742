// SPDX-License-Identifier: MIT
// FLIP: properties, and values of the authors' implementation (PyPI package flip-evaluator 1.7).
// tests/flip/check_package compares more images, where the package is installed.
#include "image/flip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

namespace clpv::flip_test {

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

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

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

}  // namespace clpv::flip_test
