// SPDX-License-Identifier: MIT
// Skins and morph targets against closed forms, static and animated.
#include <glm/gtc/constants.hpp>

#include "tests/support/gltf_builder.hpp"

namespace clpv::test::deformation_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

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

TEST_F(MorphTest, WeightsMoveInSplines) {
  // Tangents a second of the first weight: leaves with 4, over 1 s, from 0 to 0: at the middle 4 /
  // 8.
  animate<float>(0, "weights", {0, 1}, {0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0}, "CUBICSPLINE");
  MovingScene moving = load();
  moving.pose(0.5);
  EXPECT_THAT(position(moving.scene(), 0, 2), IsNear(glm::vec3(0, 1, 1), kNear));
}

}  // namespace
}  // namespace clpv::test::deformation_test
