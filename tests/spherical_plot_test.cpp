// Spherical plots against surfaces whose outlines are known, contact sheets, and `clpv basis --figures`.
#include "image/spherical_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "image/contact_sheet.hpp"
#include "image/image_io.hpp"
#include "image/label.hpp"
#include "tests/support/run_program.hpp"

namespace clpv {
namespace {

constexpr double kPi = std::numbers::pi;

bool is_blue(const Image& image, int x, int y) {
  return image.at(x, y, 2) > image.at(x, y, 0) + 0.1f;
}
bool is_red(const Image& image, int x, int y) {
  return image.at(x, y, 0) > image.at(x, y, 2) + 0.1f;
}

struct Blob {
  int pixels = 0, left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
};

template <typename Predicate>
Blob blob(const Image& image, Predicate&& inside) {
  Blob found;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!inside(image, x, y)) continue;
      ++found.pixels;
      found.left = std::min(found.left, x), found.right = std::max(found.right, x);
      found.top = std::min(found.top, y), found.bottom = std::max(found.bottom, y);
    }
  }
  return found;
}

PlottedFunction plotted(std::function<double(const glm::dvec3&)> f) {
  return {std::move(f), kPositiveColour, kNegativeColour};
}

TEST(SphericalPlot, AConstantIsADiscOfItsRadius) {
  const Image image = draw({.functions = {plotted([](const glm::dvec3&) { return 0.8; })},
                            .silhouette = {},
                            .extent = 1,
                            .size = 200});
  const Blob disc = blob(image, is_blue);
  EXPECT_NEAR(disc.pixels, kPi * 80 * 80, 0.02 * kPi * 80 * 80);
  EXPECT_NEAR(disc.right - disc.left, 160, 2);
  EXPECT_NEAR(disc.bottom - disc.top, 160, 2);
  EXPECT_EQ(blob(image, is_red).pixels, 0);
}

TEST(SphericalPlot, TheClampedCosineIsASphereThroughTheOrigin) {
  const auto cosine = [](const glm::dvec3& w) { return std::max(0.0, w.z); };
  const Image image = draw({.functions = {plotted(cosine)}, .silhouette = {}, .extent = 1, .size = 200});
  const Blob disc = blob(image, is_blue);
  EXPECT_NEAR(disc.pixels, kPi * 50 * 50, 0.06 * kPi * 50 * 50) << "an axis and its name are before it";
  EXPECT_NEAR(disc.right - disc.left, 100, 2);
  EXPECT_NEAR((disc.left + disc.right) / 2.0, 100, 1);
  EXPECT_LT(disc.bottom, 106) << "all of it is above the origin, seen from 24 degrees above";
}

TEST(SphericalPlot, NegativeLobesHaveAnotherColour) {
  const Image image = draw({.functions = {plotted([](const glm::dvec3& w) { return w.z; })},
                            .silhouette = {},
                            .extent = 1.1,
                            .size = 200});
  const Blob up = blob(image, is_blue), down = blob(image, is_red);
  EXPECT_LT(up.top, down.top);
  EXPECT_LT(up.bottom, down.bottom);
  EXPECT_NEAR(up.right - up.left, down.right - down.left, 2);
}

TEST(SphericalPlot, WhatIsNearerHides) {
  // Two spheres through the origin, towards the eye (-y) and away from it.
  const auto lobe = [](double y) { return [y](const glm::dvec3& w) { return std::max(0.0, y * w.y); }; };
  PlottedFunction near = plotted(lobe(-1)), far{lobe(1), kNegativeColour, kNegativeColour};
  const auto red = [&](std::vector<PlottedFunction> functions) {
    return blob(draw({.functions = std::move(functions), .silhouette = {}, .extent = 1, .size = 120}), is_red)
        .pixels;
  };
  const int alone = red({far});
  EXPECT_LT(red({near, far}), alone - 100);
  EXPECT_EQ(red({near, far}), red({far, near})) << "the order does not matter";
}

TEST(SphericalPlot, SilhouetteOfTheSameSphereFollowsItsEdge) {
  const auto cosine = [](const glm::dvec3& w) { return std::max(0.0, w.x); };
  const SphericalPlot without{.functions = {plotted(cosine)}, .silhouette = {}, .extent = 1, .size = 200};
  SphericalPlot with = without;
  with.silhouette = Silhouette{{0.5, 0, 0}, 0.5};
  const Image a = draw(without), b = draw(with);
  int changed = 0, far = 0;
  const Blob disc = blob(a, is_blue);
  const double cx = (disc.left + disc.right) / 2.0, cy = (disc.top + disc.bottom) / 2.0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (a.at(x, y, 0) == b.at(x, y, 0)) continue;
      ++changed;
      far += std::abs(std::hypot(x - cx, y - cy) - 50) > 3;
    }
  }
  EXPECT_GT(changed, 100);
  EXPECT_EQ(far, 0);
}

TEST(ContactSheet, PlacesTilesInRows) {
  ContactSheet sheet{{}, 2, {}};
  for (const float grey : {0.2f, 0.4f, 0.6f}) {
    Image picture = make_image(10, 8, {"R", "G", "B"});
    std::fill(picture.pixels.begin(), picture.pixels.end(), grey);
    sheet.tiles.push_back({picture, {}});
  }
  const Image image = compose(sheet);
  for (const float grey : {0.2f, 0.4f, 0.6f}) {
    const Blob tile = blob(image, [&](const Image& i, int x, int y) { return i.at(x, y, 1) == grey; });
    EXPECT_EQ(tile.pixels, 80) << grey;
    EXPECT_EQ(tile.right - tile.left, 9) << grey;
  }
  EXPECT_EQ(image.at(0, 0, 0), 1);
}

TEST(ContactSheet, CaptionsAreBelowTheirTiles) {
  if (!can_draw_labels()) GTEST_SKIP() << "no font on this system";
  Image picture = make_image(80, 20, {"R", "G", "B"});
  std::fill(picture.pixels.begin(), picture.pixels.end(), 1.0f);
  const Image image = compose({{"title"}, 1, {{picture, {"caption"}}}});
  const Blob ink = blob(image, [](const Image& i, int x, int y) { return i.at(x, y, 0) < 0.5f; });
  EXPECT_GT(ink.pixels, 50);
  EXPECT_LT(ink.top, 30);
  EXPECT_GT(ink.bottom, image.height - 40);
}

TEST(BasisFigures, AreWrittenAndListed) {
  const test::TemporaryFolder folder;
  const std::string to = (folder.path() / "new" / "folder").string();
  const test::Outcome outcome =
      test::run(std::string(CLPV_PROGRAM) + " basis srbf8v2 --lobe rotate --figures " + to);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* name : {"figure2.png", "figure3.png", "figure6.png"}) {
    EXPECT_THAT(outcome.out, ::testing::HasSubstr(name));
    const Image image = read_image(to + "/" + name);
    EXPECT_GT(blob(image, is_blue).pixels, 5000) << name;
  }
  // Six lobes of the cube: like sh2's, they reach below 0.
  EXPECT_GT(blob(read_image(to + "/figure6.png"), is_red).pixels, 100);
}

TEST(BasisFigures, AFolderThatCannotBeIsTold) {
  const test::Outcome outcome = test::run(std::string(CLPV_PROGRAM) + " basis --figures /dev/null/there");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("/dev/null/there"));
}

}  // namespace
}  // namespace clpv
