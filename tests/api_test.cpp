// SPDX-License-Identifier: MIT
// The public interface of the library (include/clpv).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "clpv/renderer.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_builder.hpp"

namespace clpv::api_test {
namespace {

using ::testing::HasSubstr;

const std::string kCornell = CLPV_SOURCE_DIR "/scenes/cornell.json";

Options small() {
  return Options()
      .set("basis", "sh2")
      .set("width", "48")
      .set("height", "27")
      .set("grid", "16")
      .set("rsm-size", "64");
}

double mean(const Image& image, std::size_t channel) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) sum += image.at(x, y, channel);
  }
  return sum / static_cast<double>(image.pixel_count());
}

TEST(Api, RendersCornell) {
  Renderer made(SceneFile(kCornell), small());
  Renderer renderer = std::move(made);
  const Image full = renderer.render(), direct = renderer.render(View::direct),
              indirect = renderer.render(View::indirect);
  ASSERT_EQ(full.pixels.size(), 48u * 27 * 4);
  EXPECT_GT(mean(indirect, 1), 0);
  EXPECT_NEAR(mean(full, 1), mean(direct, 1) + mean(indirect, 1), 1e-5 * mean(full, 1));
  EXPECT_EQ(full.metadata.at("basis"), "sh2");
  EXPECT_EQ(full.pixels, renderer.render().pixels) << "frames of one renderer are the same";
}

TEST(Api, ReturnsLightAtAnyPoint) {
  Renderer renderer(SceneFile(kCornell), small());
  EXPECT_THROW(renderer.irradiance({0.28, 0.27, 0.3}, {0, 1, 0}), Error) << "before the first frame";
  renderer.render();
  const auto up = renderer.irradiance({0.28, 0.27, 0.3}, {0, 1, 0}),
             down = renderer.irradiance({0.28, 0.27, 0.3}, {0, -4, 0});
  EXPECT_GE(up[1], 0);
  EXPECT_GT(down[1], up[1]) << "the floor is lit, the ceiling has its light from there";
  EXPECT_EQ(renderer.irradiance({0.28, 0.27, 0.3}, {0, 1, 0}), up);
  EXPECT_THROW(renderer.irradiance({0, 0, 0}, {0, 0, 0}), Error);
  EXPECT_THROW(renderer.irradiance({0, NAN, 0}, {0, 1, 0}), Error);
}

TEST(Api, AnimatedScenesRenderAtAnyTime) {
  const test::TemporaryFolder folder;
  const SceneFile scene(test::write_moving_scene(folder));
  EXPECT_TRUE(scene.moves());
  EXPECT_FALSE(SceneFile(kCornell).moves());
  Renderer renderer(scene, small()), other(scene, small());
  const Image start = renderer.render(), later = renderer.render(View::full, {}, 0.6);
  const auto light = renderer.irradiance({0, 0.5, 0}, {0, -1, 0});
  EXPECT_NE(start.pixels, later.pixels);
  EXPECT_EQ(later.metadata.at("time"), "0.6");
  EXPECT_EQ(other.render(View::full, {}, 0.6).pixels, later.pixels) << "each renderer has its own instant";
  EXPECT_EQ(renderer.render().pixels, start.pixels);
  EXPECT_NE(renderer.irradiance({0, 0.5, 0}, {0, -1, 0}), light) << "of the last frame";
  EXPECT_THROW(renderer.render(View::full, {}, NAN), Error);
  EXPECT_THROW(renderer.render(View::full, {}, 1e9), Error);
}

TEST(Api, ImagesAreSavedByTheirExtension) {
  const test::TemporaryFolder folder;
  Image image{2, 1, {"R", "G", "B", "A"}, {1, 0, 0, 1, 0, 1, 0, 1}, {}, Encoding::linear};
  for (const char* name : {"image.exr", "image.png"}) {
    save_image(folder.path() / name, image);
    EXPECT_GT(std::filesystem::file_size(folder.path() / name), 0u);
  }
  EXPECT_THROW(save_image(folder.path() / "image.tga", image), Error);
}

TEST(Api, ScenesListTheirCameras) {
  const SceneFile scene(kCornell);
  EXPECT_THAT(scene.cameras(), ::testing::Contains("front"));
  Renderer renderer(scene, small());
  EXPECT_THROW(renderer.render(View::full, "nowhere"), Error);
}

TEST(Api, OptionsAreThoseOfTheProgram) {
  const auto all = Options::all();
  EXPECT_TRUE(std::ranges::any_of(all, [](const OptionDescription& o) { return o.name == "basis"; }));
  EXPECT_THAT(test::error_of(ExitCode::usage, [] { Options().set("layout", "planes"); }),
              ::testing::AllOf(HasSubstr("planes"), HasSubstr("soa")));
  EXPECT_THROW(Options().set("no-such-option", "1"), Error);
}

TEST(Api, ErrorsHaveTheirExitCode) {
  test::error_of(ExitCode::bad_input, [] { SceneFile("/nowhere/scene.json"); });
  test::error_of(ExitCode::device, [] { Renderer(SceneFile(kCornell), small(), "no device of this name"); });
}

TEST(Api, ListsTheDeviceThatTestsRunOn) {
  EXPECT_TRUE(
      std::ranges::any_of(all_devices(), [](const DeviceDescription& d) { return d.missing.empty(); }));
}

}  // namespace
}  // namespace clpv::api_test
