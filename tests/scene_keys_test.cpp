// SPDX-License-Identifier: MIT
// Cameras and lights of scene files that move by keys: where they are at an instant, and keys that are rejected.
#include "scene/scene_keys.hpp"

#include <cmath>

#include "tests/support/bad_input.hpp"

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
  std::string rejected_file(const std::string& members) {
    const std::string message = rejection(file(members));
    EXPECT_THAT(message, HasSubstr("scene.json"));
    return message;
  }
};

TEST_F(SceneKeysTest, ACameraWalks) {
  MovingScene moving(file(R"("metres_per_unit": 0.5, )" + camera(R"("target": [0, 0, -100], "keys": [
                                   {"time": 1, "eye": [0, 0, 0], "vertical_fov_degrees": 60},
                                   {"time": 3, "eye": [4, 0, 0]},
                                   {"time": 5, "eye": [4, 8, 0], "vertical_fov_degrees": 90}])")));
  EXPECT_TRUE(moving.moves());
  EXPECT_THAT(moving.scene().cameras[0].eye, IsNear(glm::vec3(0), kClose));
  moving.pose(1.5);
  EXPECT_THAT(moving.scene().cameras[0].eye, IsNear(glm::vec3(0.5f, 0, 0), kClose)) << "in metres";
  moving.pose(4);
  const Camera& camera = moving.scene().cameras[0];
  EXPECT_THAT(camera.eye, IsNear(glm::vec3(2, 2, 0), kClose));
  EXPECT_THAT(camera.forward, IsNear(glm::normalize(glm::vec3(-4, -4, -100)), kClose)) << "the target stands";
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
  EXPECT_THAT(light.direction, ElementsAre(FloatNear(std::sqrt(0.75f), kClose), FloatNear(-0.5f, kClose), 0));
  EXPECT_THAT(light.intensity, ElementsAre(5, FloatNear(5.0f / 3, kClose), 0));
}

TEST_F(SceneKeysTest, LightsThatStep) {
  MovingScene moving(
      file(R"("lights": [{"kind": "point", "position": [0, 1, 0], "interpolation": "step", "keys": [
      {"time": 0, "intensity_candela": 1}, {"time": 1, "intensity_candela": 9}]}])"));
  moving.pose(0.999);
  EXPECT_EQ(moving.scene().lights[0].data.intensity[0], 1);
  moving.pose(1);
  EXPECT_EQ(moving.scene().lights[0].data.intensity[0], 9);
}

TEST_F(SceneKeysTest, TimesThatDoNotRise) {
  EXPECT_THAT(
      rejected_file(camera(R"("target": [0, 0, 1], "keys": [
                  {"time": 2, "eye": [0, 0, 0]}, {"time": 2, "eye": [1, 0, 0]}])")),
      AllOf(HasSubstr("/cameras/0/keys/1/time"), HasSubstr("found 2 s"), HasSubstr("more than the 2 s")));
  for (const std::string time : {"-1", "1e7", "\"noon\"", "null"}) {
    EXPECT_THAT(rejected_file(
                    camera(R"("target": [0, 0, 1], "keys": [{"time": )" + time + R"(, "eye": [0, 0, 0]}])")),
                AllOf(HasSubstr("/cameras/0/keys/0/time"), HasSubstr("a number from 0 to 1000000")));
  }
  EXPECT_THAT(rejected_file(camera(R"("target": [0, 0, 1], "keys": [{"eye": [0, 0, 0]}])")),
              AllOf(HasSubstr("/cameras/0/keys/0/time"), HasSubstr("found nothing")));
}

TEST_F(SceneKeysTest, KeysThatSayNothingOrTooMuch) {
  EXPECT_THAT(
      rejected_file(camera(R"("eye": [0, 0, 0], "target": [0, 0, 1], "keys": [{"time": 0}])")),
      AllOf(HasSubstr("/cameras/0/keys/0"), HasSubstr("a time alone"), HasSubstr("vertical_fov_degrees")));
  EXPECT_THAT(rejected_file(camera(
                  R"("eye": [0, 0, 0], "target": [0, 0, 1], "keys": [{"time": 0, "eye": [0, 0, 0]}])")),
              AllOf(HasSubstr("/cameras/0/keys/0/eye"), HasSubstr("/cameras/0/eye says too")));
  EXPECT_THAT(rejected_file(camera(R"("eye": [0, 0, 0], "target": [0, 0, 1], "keys": [])")),
              AllOf(HasSubstr("/cameras/0/keys"), HasSubstr("an array of 1 to 65536")));
  EXPECT_THAT(rejected_file(camera(R"("eye": [0, 0, 0], "target": [0, 0, 1], "interpolation": "step")")),
              AllOf(HasSubstr("/cameras/0/interpolation"), HasSubstr("no keys")));
  EXPECT_THAT(
      rejected_file(
          sun(R"("direction": [0, -1, 0], "illuminance_lux": 1, "keys": [{"time": 0, "eye": [0, 0, 0]}])")),
      AllOf(HasSubstr("/lights/0/keys/0/eye"), HasSubstr("unknown key")));
  EXPECT_THAT(
      rejected_file(sun(
          R"("illuminance_lux": 1, "interpolation": "smooth", "keys": [{"time": 0, "direction": [0, -1, 0]}])")),
      AllOf(HasSubstr("/lights/0/interpolation"), HasSubstr("linear, step")));
}

TEST_F(SceneKeysTest, DirectionsWithoutAWayBetweenThem) {
  EXPECT_THAT(rejected_file(sun(R"("illuminance_lux": 1, "keys": [
                  {"time": 0, "direction": [0, -2, 0]}, {"time": 1, "direction": [0, 1, 0]}])")),
              AllOf(HasSubstr("/lights/0/keys/1/direction"), HasSubstr("the opposite of the key before")));
  EXPECT_THAT(rejected_file(sun(R"("illuminance_lux": 1, "keys": [{"time": 0, "direction": [0, 0, 0]}])")),
              AllOf(HasSubstr("/lights/0/keys/0/direction"), HasSubstr("no length")));
}

TEST_F(SceneKeysTest, WhatNeitherTheEntryNorItsKeysSay) {
  EXPECT_THAT(rejected_file(camera(R"("keys": [{"time": 0, "eye": [0, 0, 0]}])")),
              AllOf(HasSubstr("/cameras/0/target"), HasSubstr("found nothing"), HasSubstr("or in keys")));
  EXPECT_THAT(rejected_file(sun(R"("keys": [{"time": 0, "direction": [0, -1, 0]}])")),
              AllOf(HasSubstr("/lights/0/illuminance_lux"), HasSubstr("needs it")));
  EXPECT_THAT(rejected_file(R"("lights": [{"kind": "point", "position": [0, 0, 0], "intensity_candela": 1,
                              "keys": [{"time": 0, "direction": [0, -1, 0]}]}])"),
              AllOf(HasSubstr("/lights/0/direction"), HasSubstr("a point light has not")));
}

TEST_F(SceneKeysTest, InstantsAtWhichAWayLeavesWhatIsAllowed) {
  MovingScene through(file(camera(R"("target": [0, 0, 0], "keys": [
      {"time": 0, "eye": [0, 0, 1]}, {"time": 2, "eye": [0, 0, -1]}])")));
  MovingScene over(file(camera(R"("eye": [0, 0, 0], "target": [0, 0, 1], "interpolation": "smooth", "keys": [
      {"time": 0, "vertical_fov_degrees": 10}, {"time": 1, "vertical_fov_degrees": 179},
      {"time": 5, "vertical_fov_degrees": 179}])")));
  const auto message = [](MovingScene& moving, double seconds) {
    try {
      moving.pose(seconds);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(through, 1),
              AllOf(HasSubstr("scene.json at 1 s: /cameras/0/target"), HasSubstr("the eye itself")));
  EXPECT_EQ(message(through, 1.5), "");
  EXPECT_THAT(message(over, 2),
              AllOf(HasSubstr("scene.json at 2 s: /cameras/0/vertical_fov_degrees"), HasSubstr("179.9")));
}

}  // namespace
}  // namespace clpv::test::scene_keys_test
