// SPDX-License-Identifier: MIT
// glTF animations: poses of meshes, cameras and lights at given times.
#include <glm/gtc/constants.hpp>

#include "tests/support/gltf_builder.hpp"

namespace clpv::test::animation_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr float kClose = 1e-6f;
const float kHalf = std::sqrt(0.5f);

TEST_F(AnimationTest, AMeshMovesBetweenItsKeys) {
  animate<float>(0, "translation", {1, 3}, {0, 0, 0, 4, 0, 2});
  MovingScene moving = load();
  EXPECT_TRUE(moving.moves());
  EXPECT_THAT(moving.scene().notes, Not(Contains(HasSubstr("anim"))));
  for (const auto& [seconds, wanted] :
       {std::pair(-5.0, glm::vec3(0)), std::pair(1.5, glm::vec3(1, 0, 0.5f)),
        std::pair(3.0, glm::vec3(4, 0, 2)), std::pair(99.0, glm::vec3(4, 0, 2))}) {
    moving.pose(seconds);
    EXPECT_THAT(position(moving.scene(), 0, 0), IsNear(wanted, kClose)) << seconds;
    EXPECT_THAT(position(moving.scene(), 0, 1), IsNear(wanted + glm::vec3(1, 0, 0), kClose));
    EXPECT_EQ(moving.scene().lower, position(moving.scene(), 0, 0)) << "the box goes with it";
  }
}

TEST_F(AnimationTest, PropertiesWithoutCurvesAreConstant) {
  model.document["nodes"][0]["translation"] = {5, 6, 7};
  model.document["nodes"][0]["scale"] = {2, 2, 2};
  animate<float>(0, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, kHalf, kHalf});
  MovingScene moving = load();
  moving.pose(1);
  EXPECT_THAT(position(moving.scene(), 0, 0), IsNear(glm::vec3(5, 6, 7), kClose));
  EXPECT_THAT(position(moving.scene(), 0, 1), IsNear(glm::vec3(5, 8, 7), kClose))
      << "a quarter turn about z";
}

TEST_F(AnimationTest, ParentsCarryTheirChildren) {
  // The root turns about z, its child swings out along x, the mesh is the grandchild's.
  model.document["nodes"] =
      json::parse(R"([{"children": [1]}, {"children": [2]}, {"mesh": 0, "scale": [3, 3, 3]},
                                            {"mesh": 0}])");
  animate<float>(0, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, kHalf, kHalf});
  animate<float>(1, "translation", {0, 2}, {0, 0, 0, 10, 0, 0});
  MovingScene moving = load();
  ASSERT_EQ(moving.scene().triangles.size(), 2u);
  ASSERT_EQ(moving.scene().moving.size(), 1u) << "the other one stands";
  moving.pose(1);
  EXPECT_THAT(position(moving.scene(), 0, 0), IsNear(glm::vec3(0, 5, 0), 1e-5f));
  EXPECT_THAT(position(moving.scene(), 0, 1), IsNear(glm::vec3(0, 8, 0), 1e-5f));
  EXPECT_THAT(position(moving.scene(), 1, 1), IsNear(glm::vec3(1, 0, 0), kClose));
}

TEST_F(AnimationTest, MirroredMeshesKeepTheirFront) {
  animate<float>(0, "scale", {0, 1}, {1, 1, 1, -1, 1, 1});
  MovingScene moving = load();
  for (const double seconds : {0.0, 1.0, 0.0}) {
    moving.pose(seconds);
    EXPECT_THAT(face_normal(moving.scene(), 0), IsNear(glm::vec3(0, 0, 1), kClose)) << seconds;
    EXPECT_THAT(normal(moving.scene(), 0, 0), IsNear(glm::vec3(0, 0, 1), kClose)) << seconds;
  }
}

TEST_F(AnimationTest, SplinesAndSteps) {
  // Tangents per second, over two seconds: 2 * (4 - 0) / 8 at the middle, added to the mean of 0
  // and 8.
  animate<float>(0, "translation", {0, 2}, {0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0},
                 "CUBICSPLINE");
  animate<float>(0, "scale", {0, 1}, {1, 1, 1, 5, 5, 5}, "STEP");
  MovingScene moving = load();
  moving.pose(0.99);
  EXPECT_THAT(glm::distance(position(moving.scene(), 0, 0), position(moving.scene(), 0, 1)),
              ::testing::FloatNear(1, kClose));
  moving.pose(1);
  EXPECT_THAT(position(moving.scene(), 0, 0), IsNear(glm::vec3(5, 0, 0), kClose));
  EXPECT_THAT(position(moving.scene(), 0, 1), IsNear(glm::vec3(10, 0, 0), kClose));
}

TEST_F(AnimationTest, CamerasAndLightsFollowTheirNodes) {
  model.document["cameras"] =
      json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}])");
  model.document["extensions"]["KHR_lights_punctual"]["lights"] =
      json::parse(R"([{"type": "directional"}, {"type": "point", "intensity": 3}])");
  const int head = model.add(
      "nodes",
      json::parse(R"({"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}})"));
  model.add(
      "nodes",
      json::parse(
          R"({"translation": [1, 1, 1], "extensions": {"KHR_lights_punctual": {"light": 1}}})"));
  animate<float>(head, "rotation", {0, 1}, {0, 0, 0, 1, 0, kHalf, 0, kHalf});  // -z to -x
  animate<float>(head, "translation", {0, 2}, {0, 0, 0, 0, 4, 0});
  MovingScene moving = load();
  moving.pose(1);
  const SceneData& scene = moving.scene();
  EXPECT_THAT(scene.cameras[0].eye, IsNear(glm::vec3(0, 2, 0), kClose));
  EXPECT_THAT(scene.cameras[0].forward, IsNear(glm::vec3(-1, 0, 0), kClose));
  EXPECT_THAT(scene.lights[0].data.direction,
              ::testing::Pointwise(::testing::FloatNear(kClose), {-1.f, 0.f, 0.f}));
  EXPECT_THAT(scene.lights[1].data.position, ::testing::ElementsAre(1, 1, 1));
}

TEST_F(AnimationTest, APoseDoesNotDependOnEarlierOnes) {
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 1, 2, 3});
  animate<float>(0, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, kHalf, kHalf});
  MovingScene straight = load(), wandering = load();
  straight.pose(0.3);
  for (const double seconds : {0.9, 0.1, 0.3}) wandering.pose(seconds);
  EXPECT_EQ(bytes_of(straight.scene().vertices), bytes_of(wandering.scene().vertices));
}

TEST_F(AnimationTest, FittedCascadesUseTheFirstPose) {
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 500, 0, 0});
  MovingScene moving = load();
  const double reach = moving.scene().reach();
  const glm::vec3 eye = moving.scene().cameras[0].eye;
  EXPECT_GT(reach, 0.5);
  EXPECT_LT(reach, 20);
  moving.pose(1);
  EXPECT_EQ(moving.scene().lower.x, 500);
  EXPECT_EQ(moving.scene().reach(), reach);
  EXPECT_EQ(moving.scene().cameras[0].eye, eye) << "of the camera that was added";
}

TEST_F(AnimationTest, TheFirstOfSeveralChannelsWins) {
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  model.add("animations", {{"samplers", json::array()}, {"channels", json::array()}});
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 9, 9, 9});
  MovingScene moving = load();
  EXPECT_THAT(moving.scene().notes,
              Contains(HasSubstr("/animations/1: node 0 is moved by an earlier")));
  moving.pose(1);
  EXPECT_THAT(position(moving.scene(), 0, 0), IsNear(glm::vec3(1, 0, 0), kClose));
}

TEST_F(AnimationTest, UnsupportedAnimationsGetANote) {
  animate<float>(0, "weights", {0, 1}, {0, 1});
  EXPECT_THAT(load().scene().notes, Contains(HasSubstr("/animations/0: animates weights")));
  model.document["animations"][0]["channels"][0]["target"].erase("node");
  EXPECT_THAT(load().scene().notes, Not(Contains(HasSubstr("/animations/0"))));
}

}  // namespace
}  // namespace clpv::test::animation_test
