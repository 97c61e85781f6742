// SPDX-License-Identifier: MIT
// Stability of light: closed cases of the measure, and frames of a moving camera.
#include "sequence/stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/frame/frame.hpp"
#include "pipeline/frame/frame_lights.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/view.hpp"
#include "scene/load.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::stability_test {
namespace {

using test::test_session;

constexpr int kWidth = 64, kHeight = 36;

/// G-buffer of the floor y = 0 and, where `box` > 0, of a box's top at that height over |x|, |z| <
/// 1.
SurfaceImage view_of_floor(const glm::vec3& eye, double box = 0) {
  SurfaceImage image;
  image.view = camera_view(test::camera_at(eye, {0.1f, -0.6f, -1}), kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec3 far = reference::surface_position(image.view, x, y, 1), from(eye);
      const auto meets = [&](double height) { return (height - from.y) / (far.y - from.y); };
      double depth = meets(0);
      const glm::dvec3 on_top = from + meets(box) * (far - from);
      if (box > 0 && std::abs(on_top.x) < 1 && std::abs(on_top.z) < 1) depth = meets(box);
      image.depth.push_back(depth > 0 ? static_cast<float>(depth) : 0.0f);
      image.normal.push_back(depth > 0 ? glm::vec4(0, 1, 0, 0) : glm::vec4(0));
    }
  }
  return image;
}

std::size_t count(const std::vector<bool>& counted) {
  return static_cast<std::size_t>(std::count(counted.begin(), counted.end(), true));
}

TEST(Stability, APlaneIsComparedWhereBothViewsShowIt) {
  const SurfaceImage here = view_of_floor({0, 2, 3});
  const std::size_t all = count(still_seen(here, here));
  EXPECT_EQ(all, static_cast<std::size_t>(kWidth * kHeight));
  const std::vector<bool> aside = still_seen(here, view_of_floor({0.37f, 2.05f, 2.9f}));
  EXPECT_LT(count(aside), all) << "what left the view";
  EXPECT_GT(count(aside), all * 7 / 10);
  EXPECT_EQ(count(still_seen(here, view_of_floor({5000, 2, 3}))), 0u);
}

TEST(Stability, MovedAndHiddenSurfacesAreNotCompared) {
  const SurfaceImage with = view_of_floor({0, 2, 3}, 0.3), without = view_of_floor({0.1f, 2, 3});
  const std::vector<bool> seen = still_seen(with, without);
  std::size_t on_box = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const glm::dvec3 p =
        reference::surface_position(with.view, static_cast<double>(i % kWidth),
                                    static_cast<double>(i / kWidth), double{with.depth[i]});
    on_box += p.y > 0.1;
    EXPECT_FALSE(seen[i] && p.y > 0.1) << i;
  }
  EXPECT_GT(on_box, 100u);
  EXPECT_GT(count(seen), (seen.size() - on_box) * 8 / 10) << "the floor round it";
  SurfaceImage turned = without;
  for (glm::vec4& normal : turned.normal) normal = {1, 0, 0, 0};
  EXPECT_EQ(count(still_seen(without, turned)), 0u);
}

TEST(Stability, ClosedCases) {
  std::vector<float> light(std::size_t{4} * kWidth * kHeight, 0.5f), brighter;
  for (std::size_t i = 0; i < light.size(); i += 3) light[i] = 0.125f * static_cast<float>(i % 7);
  for (const float value : light) brighter.push_back(value * 1.25f);
  const std::vector<bool> all(std::size_t{kWidth} * kHeight, true);
  const LightChange none = change_of_light(all, light, light);
  EXPECT_EQ(none.points, all.size());
  EXPECT_EQ(none.mean, 0.0);
  EXPECT_EQ(none.p95, 0.0);
  EXPECT_DOUBLE_EQ(change_of_light(all, light, brighter).mean.value(), 0.25);
  // A camera that moves over a floor under even light.
  const std::vector<float> even(light.size(), 0.75f);
  EXPECT_EQ(
      change_of_light(still_seen(view_of_floor({0, 2, 3}), view_of_floor({0.2f, 2, 3})), even, even)
          .mean,
      0.0);
  // 4 of 100 points change by 100 %: 4 % of the light, and too few for the 95th percentile.
  std::vector<float> few(400, 1.0f), flashed = few;
  for (std::size_t i = 0; i < 16; ++i) flashed[i] = 2;
  const LightChange flash = change_of_light(std::vector<bool>(100, true), few, flashed);
  EXPECT_DOUBLE_EQ(flash.mean.value(), 0.04);
  EXPECT_EQ(flash.p95, 0.0);
  EXPECT_DOUBLE_EQ(change_of_light(std::vector<bool>(4, true), few, flashed).p95.value(), 1.0);
}

TEST(Stability, DarknessAndNothingHaveNoShare) {
  const std::vector<float> dark(8, 0.0f), lit(8, 1.0f);
  EXPECT_FALSE(change_of_light({true, true}, dark, lit).mean);
  EXPECT_FALSE(change_of_light({false, false}, lit, lit).mean);
  EXPECT_EQ(change_of_light({false, true}, lit, lit).points, 1u);
}

/// The Cornell box, by a camera that moves.
class SteadyFrame : public ::testing::Test {
 protected:
  static RenderOptions small_options() {
    RenderOptions options = test::small_sweep();
    options.width = 48, options.height = 27, options.cascade_size = 1.5;
    options.rsm_size = 64, options.shadow_size = 64, options.near = Near::off;
    return options;
  }
  static constexpr float kCell = 1.5f / 16;

  void SetUp() override { camera_.eye = (glm::floor(camera_.eye / kCell) + 0.25f) * kCell; }

  /// Moves the camera by that many cells, and returns the change of light on surfaces visible
  /// before and after.
  LightChange after(float cells) {
    if (before_.depth.empty()) render();
    camera_.eye.x += cells * kCell;
    const SurfaceImage seen = before_;
    const std::vector<float> irradiance = irradiance_;
    render();
    return change_of_light(still_seen(seen, before_), irradiance, frame_.irradiance_on(seen));
  }
  void render() {
    frame_.render(camera_);
    before_ = read_surface(test_session(), frame_.seen());
    irradiance_ = frame_.read(Show::irradiance);
  }

  SceneData scene_ = load_scene(test::scene_file("cornell.json"));
  SceneCamera camera_ = scene_.camera("");
  Frame frame_{test_session(), scene_, small_options()};
  SurfaceImage before_;
  std::vector<float> irradiance_;
};

TEST_F(SteadyFrame, LightChangesLittleAsTheEyeMovesAndAsMuchAsTheLight) {
  EXPECT_EQ(after(0).mean, 0.0);
  const LightChange inside = after(0.5f);
  EXPECT_LT(inside.mean.value(), 0.02) << "cascades hand over elsewhere";
  EXPECT_GT(inside.points, std::size_t{48 * 27 / 2});
  const double across = after(1).mean.value();
  EXPECT_GT(across, 0.0) << "another cell";
  EXPECT_LT(across, 0.08);
  for (SceneLight& light : scene_.lights) light.data = scaled(light.data, 1.25f);
  EXPECT_NEAR(after(0).mean.value(), 0.25, 1e-3) << "halves round";
}

}  // namespace
}  // namespace clpv::stability_test
