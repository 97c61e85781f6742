// SPDX-License-Identifier: MIT
// Light on the pixels of a caller's G-buffer (Renderer::light).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "clpv/renderer.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::light_test {
using ::testing::HasSubstr;
using Vectors = std::vector<std::array<float, 3>>;
using test::colours;
using test::kCornell;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();

Options small(int width = 48, int height = 27) {
  return test::small_options()
      .set("width", std::to_string(width))
      .set("height", std::to_string(height));
}

Camera camera_of(const Scene& scene) {
  return scene.cameras().front();
}

/// G-buffer and irradiance of a frame.
struct Seen {
  int width, height;
  Vectors normals, irradiance;
  std::vector<float> depths;

  Seen(Renderer& renderer, const CameraChoice& camera, double seconds = 0) {
    const Image image = renderer.render(View::irradiance, camera, seconds);
    width = image.width, height = image.height;
    irradiance = colours(image.pixels);
    normals = colours(renderer.show(View::normal).pixels);
    for (const auto& depth : colours(renderer.show(View::depth).pixels)) depths.push_back(depth[0]);
  }
  GBuffer buffer() const {
    return {.width = width, .height = height, .normals = normals, .depths = depths};
  }
};

double greatest(const Vectors& a, const Vectors& minus) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(double{a[i][c]} - minus[i][c]));
  }
  return most;
}

double greatest(const Vectors& a) {
  return greatest(a, Vectors(a.size()));
}

TEST(Light, OfAFramesDepthsIsItsIrradianceToTheByte) {
  const Scene scene(kCornell);
  for (const char* size : {"full", "half"}) {
    Renderer renderer(scene, small().set("near-size", size)),
        other(scene, small().set("near-size", size));
    const Camera camera = camera_of(scene);
    const Seen seen(renderer, camera);
    EXPECT_GT(greatest(seen.irradiance), 0);
    EXPECT_EQ(other.light(seen.buffer(), camera), seen.irradiance)
        << size << ", without a frame before";
    EXPECT_GT(ms_of(other.stats().times, "near-trace"), 0);
    other.light(seen.buffer(), camera);
    EXPECT_EQ(ms_of(other.stats().times, "propagate"), 0) << "cached";
  }
}

/// The walls of a box about the eye, seen by a panoramic camera of equal angles.
struct Panorama {
  static constexpr int kWidth = 37, kHeight = 18;
  Vectors positions, normals;

  Panorama(const Vec3& eye, const std::array<Vec3, 2>& box) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double polar = M_PI * (y + 0.5) / kHeight, azimuth = 2 * M_PI * (x + 0.5) / kWidth;
        const double ray[] = {std::sin(polar) * std::cos(azimuth), std::cos(polar),
                              std::sin(polar) * std::sin(azimuth)};
        double nearest = kInfinity;
        int axis = 0;
        for (int i = 0; i < 3; ++i) {
          const double t = ((ray[i] > 0 ? box[1][i] : box[0][i]) - eye[i]) / ray[i];
          if (t < nearest) nearest = t, axis = i;
        }
        auto &p = positions.emplace_back(), &n = normals.emplace_back();
        for (int i = 0; i < 3; ++i) p[i] = static_cast<float>(eye[i] + nearest * ray[i]);
        n[axis] = ray[axis] > 0 ? -3.0f : 3.0f;
      }
    }
  }
  GBuffer buffer() const { return {kWidth, kHeight, normals, positions}; }
};

TEST(Light, OfAPanoramaWithoutTheNearFieldIsTheIrradianceOfItsPointsOffEdges) {
  const Scene scene(kCornell);
  Renderer renderer(scene, small().set("near", "off"));
  const Vec3 eye{0.278, 0.273, 0.2};
  const Panorama seen(eye, {{{0, 0, 0}, {0.556, 0.5488, 0.5592}}});  // the inner faces of the walls
  const Vectors light = renderer.light(seen.buffer(), eye);
  EXPECT_GT(greatest(light), 0);
  const Vectors of_points = renderer.irradiance(seen.positions, seen.normals);
  std::size_t others = 0;  // behind the blocks and at their edges, where points have no eye
  for (std::size_t i = 0; i < light.size(); ++i) others += light[i] != of_points[i];
  EXPECT_LT(others, light.size() / 4) << "of the cascades about the eye";
  Renderer traced(scene, small());
  EXPECT_GT(greatest(traced.light(seen.buffer(), eye), light), 0.01 * greatest(light))
      << "the near field";
}

TEST(Light, PixelsWithoutASurfaceAreDarkAndChangeNoOther) {
  const Scene scene(kCornell);
  Renderer renderer(scene, small().set("near", "off"));
  const Camera camera = camera_of(scene);
  Seen seen(renderer, camera);
  const Vec3 eye{0.278, 0.273, 0.2};
  Panorama around(eye, scene.bounds());
  Vectors expected = seen.irradiance, of_positions = renderer.light(around.buffer(), eye);
  const std::array<float, 3> none[] = {{0, 0, 0}, {kNan, 0, 1}, {0, kInfinity, 0}};
  for (int i = 0; i < 3; ++i) {
    seen.normals[100 + i] = around.normals[100 + i] = none[i];
    expected[100 + i] = of_positions[100 + i] = {};
  }
  const float depths[] = {0, -1, kNan, kInfinity};
  for (int i = 0; i < 4; ++i) {
    seen.depths[200 + i] = depths[i];
    around.positions[200 + i][i % 3] = i == 3 ? -kInfinity : kNan;
    expected[200 + i] = of_positions[200 + i] = {};
  }
  EXPECT_EQ(renderer.light(seen.buffer(), camera), expected);
  EXPECT_EQ(renderer.light(around.buffer(), eye), of_positions);
  seen.normals[0] = {1e-30f * seen.normals[0][0], 1e-30f * seen.normals[0][1],
                     1e-30f * seen.normals[0][2]};
  EXPECT_NEAR(renderer.light(seen.buffer(), camera)[0][1], expected[0][1], 1e-4 * expected[0][1])
      << "of any length";
}

TEST(Light, FramesAndOtherSizesBetweenDoNotChangeIt) {
  const Scene scene(kCornell);
  Renderer renderer(scene, small().set("near-size", "half"));
  const Camera camera = camera_of(scene);
  const Seen seen(renderer, camera);
  const Vec3 eye{0.278, 0.273, 0.2};
  const Panorama around(eye, scene.bounds());
  const Vectors first = renderer.light(around.buffer(), eye);
  // As many near pixels in other rows: the empty borders lie elsewhere.
  const GBuffer upright{Panorama::kHeight, Panorama::kWidth, around.normals, around.positions};
  const Vectors turned = renderer.light(upright, eye);
  EXPECT_EQ(renderer.show(View::irradiance).pixels,
            renderer.render(View::irradiance, camera).pixels)
      << "still shown";
  EXPECT_EQ(renderer.light(seen.buffer(), camera), seen.irradiance);
  EXPECT_EQ(renderer.light(upright, eye), turned);
  EXPECT_EQ(renderer.light(around.buffer(), eye), first);
}

TEST(Light, OfAnAnimatedSceneIsThatOfItsTime) {
  const test::TemporaryFolder folder;
  const Scene scene(test::write_moving_scene(folder));
  Renderer renderer(scene, small()), other(scene, small());
  const Camera camera = camera_of(scene);
  const Seen later(renderer, camera, 0.6);
  EXPECT_EQ(other.light(later.buffer(), camera, 0.6), later.irradiance);
  EXPECT_NE(other.light(later.buffer(), camera), later.irradiance);
}

TEST(Light, RejectsBadSizesAndCameras) {
  const Scene scene(kCornell);
  Renderer renderer(scene, small());
  const Vectors four(4, {0, 1, 0}), three(3, {0, 1, 0});
  const std::vector<float> depths(4, 1.0f);
  const auto rejected = [&](const std::string& part, const GBuffer& surfaces,
                            const Vec3& eye = {}) {
    EXPECT_THAT(test::error_of(ExitCode::usage, [&] { renderer.light(surfaces, eye); }),
                ::testing::AllOf(HasSubstr("light: "), HasSubstr(part), HasSubstr("allowed")));
  };
  rejected("found 0 x 4", {0, 4, four, four});
  rejected("found 3 normals for 2 x 2 pixels", {2, 2, three, four});
  rejected("found 3 positions", {2, 2, four, three});
  rejected("found 0 depths for 2 x 2 pixels, allowed: one for each, or positions", {2, 2, four});
  rejected("found positions and depths", {2, 2, four, four, depths});
  rejected("found depths and an eye", {2, 2, four, {}, depths});
  rejected("eye: found", {2, 2, four, four}, {0, NAN, 0});
  EXPECT_THROW(renderer.light({2, 2, four, {}, depths}, "nowhere"), Error);
  EXPECT_THROW(renderer.volumes(), Error) << "no light yet";
  Renderer by_view(scene, test::small_images()
                              .set("transport", "exact")
                              .set("blockers", "seen")
                              .set("blocking", "one-sided")
                              .set("near", "off"));
  EXPECT_THAT(test::error_of(ExitCode::usage,
                             [&] {
                               by_view.light({2, 2, four, four}, Vec3{});
                             }),
              HasSubstr("blockers 'seen'"));
}

}  // namespace clpv::light_test
