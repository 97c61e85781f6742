// SPDX-License-Identifier: MIT
// glTF animations: poses of meshes, cameras and lights at given times.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/motion.hpp"
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

// Curves through keys against their closed forms.

constexpr double kExact = 1e-14;  // a few roundings of numbers near 1
constexpr double kPi = glm::pi<double>();

std::vector<double> at(const Curve& curve, double seconds) {
  std::vector<double> value(curve.components);
  evaluate(curve, seconds, value);
  return value;
}

/// x, y, z, w of a turn about an axis.
std::vector<double> turn(const glm::dvec3& axis, double angle) {
  const glm::dvec3 v = axis * std::sin(angle / 2);
  return {v.x, v.y, v.z, std::cos(angle / 2)};
}

std::vector<double> joined(const std::vector<std::vector<double>>& parts) {
  std::vector<double> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(Curve, SplineIsTheCubicOfItsValuesAndSlopes) {
  // p(x) = 2x^3 - 3x^2 + x + 5 and its slope 6x^2 - 6x + 1, at uneven keys: every piece is the same
  // cubic.
  const auto p = [](double x) { return ((2 * x - 3) * x + 1) * x + 5; };
  const auto slope = [](double x) { return (6 * x - 6) * x + 1; };
  Curve curve{Interpolation::cubic_spline, 1, {0, 0.5, 2}, {}};
  for (const double x : curve.times)
    curve.values = joined({curve.values, {slope(x), p(x), slope(x)}});
  for (const double x : {0.0, 0.1, 0.25, 0.5, 0.6, 1.0, 1.7, 2.0})
    EXPECT_NEAR(at(curve, x)[0], p(x), 10 * kExact) << x;
}

TEST(Curve, SplineLeavesByOneTangentAndArrivesByTheOther) {
  // Hermite's basis at one half: (1, 1, 1/8, -1/8) of (from / 2, to / 2, span * leaving, span *
  // arriving).
  const Curve curve{Interpolation::cubic_spline, 1, {0, 4}, {100, 1, 2, 3, 5, 100}};
  EXPECT_NEAR(at(curve, 2)[0], 0.5 + 2.5 + 4 * 2.0 / 8 - 4 * 3.0 / 8, kExact);
}

TEST(Curve, RotationsTurnEvenlyAboutTheirAxis) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, -2));
  const Curve curve{Interpolation::linear, 4, {0, 2}, joined({turn(axis, 0.2), turn(axis, 1.4)})};
  for (const double share : {0.0, 0.25, 0.5, 0.9}) {
    const glm::dquat q = rotation_at(curve, 2 * share);
    EXPECT_THAT((std::vector{q.x, q.y, q.z, q.w}),
                testing::Pointwise(testing::DoubleNear(kExact), turn(axis, 0.2 + 1.2 * share)))
        << share;
  }
}

TEST(Curve, RotationsTakeTheShorterWay) {
  // The same rotation with its sign turned: half way from 0 to 90 degrees is 45, not 225.
  std::vector<double> there = turn({0, 0, 1}, kPi / 2);
  for (double& v : there) v = -v;
  const Curve curve{Interpolation::linear, 4, {0, 1}, joined({turn({0, 0, 1}, 0), there})};
  const glm::dvec3 turned = rotation_at(curve, 0.5) * glm::dvec3(1, 0, 0);
  EXPECT_NEAR(turned.x, std::sqrt(0.5), kExact);
  EXPECT_NEAR(turned.y, std::sqrt(0.5), kExact);
}

TEST(Curve, SplinesOfRotationsAreMadeUnit) {
  const std::vector<double> none(4, 0.0);
  const Curve curve{Interpolation::cubic_spline,
                    4,
                    {0, 1},
                    joined({none, turn({0, 1, 0}, 0), none, none, turn({0, 1, 0}, 1), none})};
  const glm::dquat half = rotation_at(curve, 0.5);
  EXPECT_NEAR(glm::length(half), 1, kExact);
  EXPECT_NEAR(half.y, std::sin(0.25), kExact) << "half of two unit quaternions points half way";
}

// Skins and morph targets against closed forms, static and animated.

constexpr float kNear = 1e-6f;

/// A skinned triangle: (0,0,0) follows joint 0, (1,0,0) joint 1, (0,1,0) both with weight 1/2.
struct SkinTest : AnimationTest {
  SkinTest() {
    primitive()["attributes"]["JOINTS_0"] =
        model.accessor<std::uint8_t>("VEC4", {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
    primitive()["attributes"]["WEIGHTS_0"] =
        model.accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0});
    model.document["nodes"][0]["skin"] = 0;
    for (int i = 0; i < 2; ++i) model.add("nodes", {{"name", "joint"}});
    model.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", binds({0, 0, 0, -2, 0, 0})}});
  }

  /// Inverse bind matrices that only move.
  int binds(const std::vector<float>& moves) {
    std::vector<float> values;
    for (std::size_t i = 0; i + 2 < moves.size(); i += 3) {
      for (const float v : {1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, moves[i],
                            moves[i + 1], moves[i + 2], 1.f})
        values.push_back(v);
    }
    json made = {{"bufferView", model.view(bytes_of(values))},
                 {"componentType", 5126},
                 {"count", moves.size() / 3},
                 {"type", "MAT4"}};
    return model.add("accessors", made);
  }
};

TEST_F(SkinTest, VerticesFollowTheirJoints) {
  model.document["nodes"][0]["translation"] = {50, 50, 50};  // ignored: the joints place it
  model.document["nodes"][1]["translation"] = {0, 0, 4};
  model.document["nodes"][2]["translation"] = {2, 10, 0};
  const SceneData scene = load_scene(model.write(folder));
  EXPECT_THAT(position(scene, 0, 0), IsNear(glm::vec3(0, 0, 4), kNear));
  EXPECT_THAT(position(scene, 0, 1), IsNear(glm::vec3(1, 10, 0), kNear))
      << "its bind matrix takes 2 off";
  EXPECT_THAT(position(scene, 0, 2), IsNear(glm::vec3(0, 6, 2), kNear))
      << "half way between the two";
  EXPECT_TRUE(scene.moving.empty());
  EXPECT_THAT(scene.notes, Not(Contains(HasSubstr("skin"))));
}

TEST_F(SkinTest, JointsMoveAndTheirChildrenToo) {
  model.document["nodes"][1]["children"] = {2};
  model.document["nodes"][2]["translation"] = {2, 0, 0};
  animate<float>(1, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, std::sqrt(0.5f), std::sqrt(0.5f)});
  MovingScene moving = load();
  ASSERT_EQ(moving.scene().moving.size(), 1u);
  moving.pose(1);  // x turns to y, all about the origin
  EXPECT_THAT(position(moving.scene(), 0, 1), IsNear(glm::vec3(0, 1, 0), kNear));
  EXPECT_THAT(position(moving.scene(), 0, 2), IsNear(glm::vec3(-1, 0, 0), kNear));
  moving.pose(0);
  EXPECT_THAT(position(moving.scene(), 0, 1), IsNear(glm::vec3(1, 0, 0), kNear));
}

TEST_F(SkinTest, NormalsTurnWithTheirJoints) {
  primitive()["attributes"]["NORMAL"] = model.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  const float half = std::sqrt(0.5f);
  model.document["nodes"][2] = {{"translation", {2, 0, 0}},
                                {"rotation", {0, half, 0, half}}};  // z to x
  const SceneData scene = load_scene(model.write(folder));
  EXPECT_THAT(normal(scene, 0, 0), IsNear(glm::vec3(0, 0, 1), kNear));
  EXPECT_THAT(normal(scene, 0, 1), IsNear(glm::vec3(1, 0, 0), kNear));
}

// The first vertex once decided for all triangles of a skin.
TEST_F(SkinTest, TrianglesTurnOverWhereMostOfTheirJointsMirror) {
  model.document["skins"][0].erase("inverseBindMatrices");
  model.document["nodes"][1]["scale"] = {-1, 1, 1};
  primitive()["attributes"]["WEIGHTS_0"] =
      model.accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  for (std::uint8_t joints = 0; joints < 8; ++joints) {  // a bit for each vertex: joint 1 is plain
    const std::uint8_t a = joints & 1, b = joints >> 1 & 1, c = joints >> 2;
    primitive()["attributes"]["JOINTS_0"] =
        model.accessor<std::uint8_t>("VEC4", {a, 0, 0, 0, b, 0, 0, 0, c, 0, 0, 0});
    const SceneData scene = load_scene(model.write(folder));
    EXPECT_EQ(scene.triangles.at(0).vertex[1], a + b + c >= 2 ? 1u : 2u) << int{joints};
  }
}

TEST_F(SkinTest, WeightsAreSharesAndNoneMeansTheFirstJoint) {
  model.document["nodes"][2]["translation"] = {2, 10, 0};
  primitive()["attributes"]["WEIGHTS_0"] =
      model.accessor<float>("VEC4", {0, 0, 0, 0, 5, 0, 0, 0, 3, 1, 0, 0});
  const SceneData scene = load_scene(model.write(folder));
  EXPECT_THAT(position(scene, 0, 0), IsNear(glm::vec3(0), kNear));
  EXPECT_THAT(position(scene, 0, 1), IsNear(glm::vec3(1, 10, 0), kNear));
  EXPECT_THAT(position(scene, 0, 2), IsNear(glm::vec3(0, 3.5f, 0), kNear));
}

/// The triangle with two targets: one lifts its third corner by 2, the other moves its second one.
struct MorphTest : AnimationTest {
  MorphTest() {
    primitive()["targets"] = {
        {{"POSITION", model.accessor<float>("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 2})}},
        {{"POSITION", model.accessor<float>("VEC3", {0, 0, 0, 3, 0, 0, 0, 0, 0})}}};
  }
};

TEST_F(MorphTest, TargetsAddUpByTheWeightsOfTheNodeElseTheMesh) {
  EXPECT_THAT(position(load_scene(model.write(folder)), 0, 2), IsNear(glm::vec3(0, 1, 0), kNear));
  model.document["meshes"][0]["weights"] = {0.5, -1};
  EXPECT_THAT(load_scene(model.write(folder)).notes, Not(Contains(HasSubstr("not morphed"))));
  const int deltas = model.accessor<float>("VEC3", std::vector<float>(9, -1));
  for (const char* name : {"TEXCOORD_0", "COLOR_0", "TANGENT"})
    primitive()["targets"][1][name] = deltas;
  const SceneData of_mesh = load_scene(model.write(folder));
  EXPECT_THAT(of_mesh.notes,
              Contains("/meshes/0/primitives/0/targets: not morphed: COLOR_0, TEXCOORD_0"));
  EXPECT_THAT(position(of_mesh, 0, 2), IsNear(glm::vec3(0, 1, 1), kNear));
  EXPECT_THAT(position(of_mesh, 0, 1), IsNear(glm::vec3(-2, 0, 0), kNear));
  model.document["nodes"][0]["weights"] = {1, 0};
  const SceneData of_node = load_scene(model.write(folder));
  EXPECT_THAT(position(of_node, 0, 2), IsNear(glm::vec3(0, 1, 2), kNear));
  EXPECT_THAT(normal(of_node, 0, 0), IsNear(face_normal(of_node, 0), kNear))
      << "flat normals are recomputed";
  EXPECT_TRUE(of_node.moving.empty());
}

TEST_F(MorphTest, StoredNormalsTakeTheirTargets) {
  primitive()["attributes"]["NORMAL"] = model.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  primitive()["targets"][0]["NORMAL"] = model.accessor<float>("VEC3", {1, 0, 0, 0, 0, 0, 0, 0, -2});
  model.document["meshes"][0]["weights"] = {1, 0};
  const SceneData scene = load_scene(model.write(folder));
  EXPECT_THAT(normal(scene, 0, 0), IsNear(glm::normalize(glm::vec3(1, 0, 1)), kNear));
  EXPECT_THAT(normal(scene, 0, 1), IsNear(glm::vec3(0, 0, 1), kNear));
  EXPECT_THAT(normal(scene, 0, 2), IsNear(glm::vec3(0, 0, -1), kNear));
}

TEST_F(MorphTest, WeightsMove) {
  animate<float>(0, "weights", {0, 2}, {0, 0, 1, 0.5f});
  MovingScene moving = load();
  EXPECT_THAT(moving.scene().notes, Not(Contains(HasSubstr("weights"))));
  ASSERT_EQ(moving.scene().moving.size(), 1u);
  moving.pose(1);
  EXPECT_THAT(position(moving.scene(), 0, 2), IsNear(glm::vec3(0, 1, 1), kNear));
  EXPECT_THAT(position(moving.scene(), 0, 1), IsNear(glm::vec3(1.75f, 0, 0), kNear));
  moving.pose(0);
  EXPECT_THAT(position(moving.scene(), 0, 2), IsNear(glm::vec3(0, 1, 0), kNear));
}

}  // namespace
}  // namespace clpv::test::animation_test
