// SPDX-License-Identifier: MIT
// Cameras and lights of scene files that move by keys.
#include "scene/scene_keys.hpp"

#include <cmath>

#include "tests/support/gltf_builder.hpp"

namespace clpv::test::scene_keys_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;

constexpr float kClose = 1e-6f;

struct SceneKeysTest : BadInputTest {
  /// A scene file with the triangle, and these members.
  std::filesystem::path file(const std::string& members) {
    model.write(folder);
    return folder.write("scene.json", R"({"model": "model.gltf", )" + members + "}");
  }
  static std::string camera(const std::string& members) {
    return R"("cameras": [{"name": "walk", )" + members + "}]";
  }
  static std::string sun(const std::string& members) {
    return R"("lights": [{"kind": "directional", )" + members + "}]";
  }
};

TEST_F(SceneKeysTest, ACameraWalks) {
  MovingScene moving(
      file(R"("metres_per_unit": 0.5, )" + camera(R"("target": [0, 0, -100], "keys": [
                                   {"time": 1, "eye": [0, 0, 0], "vertical_fov_degrees": 60},
                                   {"time": 3, "eye": [4, 0, 0]},
                                   {"time": 5, "eye": [4, 8, 0], "vertical_fov_degrees": 90}])")));
  EXPECT_TRUE(moving.moves());
  EXPECT_THAT(moving.scene().cameras[0].eye, IsNear(glm::vec3(0), kClose));
  moving.pose(1.5);
  EXPECT_THAT(moving.scene().cameras[0].eye, IsNear(glm::vec3(0.5f, 0, 0), kClose)) << "in metres";
  moving.pose(4);
  const SceneCamera& camera = moving.scene().cameras[0];
  EXPECT_THAT(camera.eye, IsNear(glm::vec3(2, 2, 0), kClose));
  EXPECT_THAT(camera.forward, IsNear(glm::normalize(glm::vec3(-4, -4, -100)), kClose))
      << "the target stands";
  EXPECT_NEAR(camera.vertical_fov, glm::radians(82.5), kClose)
      << "by the keys that name it, three quarters of the way";
  moving.pose(50);
  EXPECT_THAT(moving.scene().cameras[0].eye, IsNear(glm::vec3(2, 4, 0), kClose));
}

TEST_F(SceneKeysTest, SmoothIsAtRestAtTheEndsAndWithoutAJumpOfSpeed) {
  MovingScene moving(file(camera(R"("target": [0, 0, -100], "interpolation": "smooth", "keys": [
      {"time": 0, "eye": [0, 0, 0]}, {"time": 1, "eye": [1, 0, 0]}, {"time": 3, "eye": [5, 0, 0]}])")));
  const auto x = [&](double seconds) {
    moving.pose(seconds);
    return static_cast<double>(moving.scene().cameras[0].eye.x);
  };
  constexpr double kStep = 1e-3, kFlat = 1e-4;
  EXPECT_NEAR(x(kStep), 0, kFlat * kStep * 1e3);
  EXPECT_NEAR(x(3 - kStep), 5, kFlat * kStep * 1e3);
  // Slopes 1 before and 2 after: the parabola's is (1 * 2 + 2 * 1) / 3 there, from either side.
  EXPECT_NEAR((x(1) - x(1 - kStep)) / kStep, 4.0 / 3, 1e-2);
  EXPECT_NEAR((x(1 + kStep) - x(1)) / kStep, 4.0 / 3, 1e-2);
  EXPECT_EQ(x(1), 1);
}

TEST_F(SceneKeysTest, ASunCrossesTheSkyAlongAGreatCircle) {
  MovingScene moving(file(sun(R"("illuminance_lux": 5, "keys": [
      {"time": 0, "direction": [1, 0, 0], "colour": [1, 0, 0]}, {"time": 6, "direction": [0, -3, 0], "colour": [1, 1, 0]}])")));
  moving.pose(2);
  const ClpvLight& light = moving.scene().lights[0].data;
  EXPECT_THAT(light.direction,
              ElementsAre(FloatNear(std::sqrt(0.75f), kClose), FloatNear(-0.5f, kClose), 0));
  EXPECT_THAT(light.intensity, ElementsAre(5, FloatNear(5.0f / 3, kClose), 0));
}

TEST_F(SceneKeysTest, CurvesThatLeaveTheAllowedRange) {
  MovingScene through(file(camera(R"("target": [0, 0, 0], "keys": [
      {"time": 0, "eye": [0, 0, 1]}, {"time": 2, "eye": [0, 0, -1]}])")));
  MovingScene over(
      file(camera(R"("eye": [0, 0, 0], "target": [0, 0, 1], "interpolation": "smooth", "keys": [
      {"time": 0, "vertical_fov_degrees": 10}, {"time": 1, "vertical_fov_degrees": 179},
      {"time": 5, "vertical_fov_degrees": 179}])")));
  const auto message = [](MovingScene& moving, double seconds) {
    return error_of(ExitCode::bad_input, [&] { moving.pose(seconds); });
  };
  EXPECT_THAT(message(through, 1), AllOf(HasSubstr("scene.json at 1 s: /cameras/0/target"),
                                         HasSubstr("the eye itself")));
  EXPECT_NO_THROW(through.pose(1.5));
  EXPECT_THAT(
      message(over, 2),
      AllOf(HasSubstr("scene.json at 2 s: /cameras/0/vertical_fov_degrees"), HasSubstr("179.9")));
}

}  // namespace
}  // namespace clpv::test::scene_keys_test
