// SPDX-License-Identifier: MIT
// Scene files: keys, precedence over the model, defaults.

#include "clpv/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/load.hpp"
#include "scene/scene.hpp"
#include "scene/scene_file.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::scene_test {

namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr float kClose = 1e-6f;

constexpr const char* kFull = R"({
  "comment": "what it shows",
  "model": "models/model.gltf",
  "metres_per_unit": 0.5,
  "exposure": -1.5,
  "cameras": [
    {"name": "a", "eye": [2, 4, 6], "target": [2, 4, 0], "vertical_fov_degrees": 90, "near": 0.5, "light": "sun"},
    {"name": "b", "eye": [0, 0, 0], "target": [0, 3, 0], "up": [0, 1, 1]}],
  "lights": [
    {"name": "sun", "kind": "directional", "direction": [0, -2, 0], "illuminance_lux": 10, "colour": [1, 0.5, 0]},
    {"kind": "point", "position": [2, 0, 0], "intensity_candela": 7, "range": 8},
    {"name": "torch", "kind": "spot", "position": [0, 2, 0], "direction": [1, 0, 0], "intensity_candela": 3,
     "inner_cone_degrees": 20, "outer_cone_degrees": 60}],
  "cascades": {"count": 2, "size_metres": 8}
})";

/// A model with a triangle, a camera and a light, in models/.
struct SceneTest : ::testing::Test {
  TemporaryFolder folder;

  GltfBuilder model() {
    GltfBuilder made;
    made.triangle();
    made.document["cameras"] = {
        {{"name", "own"}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    made.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"name", "lamp"}, {"type", "point"}, {"range", 4}}};
    made.add("nodes", {{"camera", 0},
                       {"translation", {0, 0, 8}},
                       {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return made;
  }

  void SetUp() override {
    GltfBuilder made = model();
    made.finish("model.bin");
    folder.write("models/model.bin", made.binary);
    folder.write("models/model.gltf", made.document.dump());
  }

  SceneData load(const std::string& text, const std::filesystem::path& replacement = {}) {
    return load_scene(folder.write("test.json", text), replacement);
  }
};

TEST_F(SceneTest, NotesOnViewsThatTheFileReplacesAreLeftOut) {
  GltfBuilder made = model();
  made.add("nodes", {{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  made.finish("model.bin");
  folder.write("models/model.gltf", made.document.dump());
  const std::string model = R"({"model": "models/model.gltf")";
  EXPECT_EQ(load(model + "}").notes.size(), 2u);
  const std::string cameras = R"(, "cameras": [{"name": "a", "eye": [0, 0, 1],
                                                "target": [0, 0, 0]}])";
  EXPECT_THAT(load(model + cameras + "}").notes,
              ::testing::ElementsAre(::testing::HasSubstr("2 lights have the name 'lamp'")));
  EXPECT_THAT(load(model + cameras + R"(, "lights": []})").notes, ::testing::IsEmpty());
}

TEST_F(SceneTest, LightScaleMultipliesTheLightsOfModelAndFile) {
  const auto intensity = [](const SceneData& scene) {
    return scene.lights_for(scene.cameras.at(0)).at(0).data.intensity[0];
  };
  const std::string model = R"({"model": "models/model.gltf")",
                    lamp = R"(, "lights": [{"kind": "point", "position": [0, 0, 0],
                             "intensity_candela": 6}])";
  EXPECT_EQ(intensity(load(model + "}")), 1);
  EXPECT_EQ(intensity(load(model + R"(, "light_scale": 0.25})")), 0.25f);
  EXPECT_EQ(intensity(load(model + lamp + R"(, "light_scale": 0.25})")), 1.5f);
  const std::filesystem::path file =
      folder.write("scaled.json", model + R"(, "light_scale": 0.25})");
  EXPECT_EQ(clpv::Scene(file).lights().at(0).intensity[0], 0.25);
  MovingScene scene(file);
  scene.set_light_scale(3);  // in place of the file's
  EXPECT_EQ(intensity(scene.scene()), 3);
  scene.set_lights(scene.scene().lights);
  EXPECT_EQ(intensity(scene.scene()), 1) << "a caller's lights are not scaled";
}

TEST_F(SceneTest, AllKeysOfASceneFileInMetres) {
  const SceneData scene = load(kFull);
  EXPECT_EQ(scene.name, "test");
  EXPECT_EQ(scene.exposure, -1.5f);
  EXPECT_EQ(scene.cascades, 2);
  EXPECT_EQ(scene.cascade_size, 8.0f);
  EXPECT_EQ(scene.upper, glm::vec3(0.5f, 0.5f, 0)) << "half a metre per unit";
  EXPECT_THAT(scene.notes, IsEmpty());
  ASSERT_EQ(scene.cameras.size(), 2u);
  const SceneCamera& a = scene.cameras[0];
  EXPECT_EQ(a.eye, glm::vec3(1, 2, 3));
  EXPECT_THAT(a.forward, IsNear(glm::vec3(0, 0, -1), kClose));
  EXPECT_NEAR(a.vertical_fov, glm::half_pi<float>(), kClose);
  EXPECT_EQ(a.near_depth, 0.25f);
  const SceneCamera& b = scene.cameras[1];
  EXPECT_THAT(b.up, IsNear(glm::vec3(0, 0, 1), kClose)) << "made perpendicular";
  EXPECT_NEAR(b.vertical_fov, glm::pi<float>() / 3, kClose) << "60 degrees by default";
  ASSERT_EQ(scene.lights.size(), 3u);
  const ClpvLight &sun = scene.lights[0].data, &lamp = scene.lights[1].data,
                  &torch = scene.lights[2].data;
  EXPECT_THAT(sun.direction, ElementsAre(0, -1, 0));
  EXPECT_THAT(sun.intensity, ElementsAre(10, 5, 0));
  EXPECT_THAT(lamp.position, ElementsAre(1, 0, 0));
  EXPECT_EQ(lamp.range, 4);
  EXPECT_THAT(lamp.intensity, ElementsAre(7, 7, 7));
  EXPECT_EQ(torch.kind, static_cast<unsigned>(CLPV_LIGHT_SPOT));
  EXPECT_NEAR(std::cos(glm::radians(20.f)) * torch.cone_scale + torch.cone_offset, 1, 1e-5);
  EXPECT_NEAR(std::cos(glm::radians(60.f)) * torch.cone_scale + torch.cone_offset, 0, 1e-5);
  const auto only = scene.lights_for(scene.camera("a"));
  ASSERT_EQ(only.size(), 1u);
  EXPECT_EQ(only[0].name, "sun");
  EXPECT_EQ(scene.lights_for(scene.camera("b")).size(), 3u);
}

// It renders black.
TEST_F(SceneTest, ASceneTooSmallForLampsIsNoted) {
  std::string small = kFull;
  small.replace(small.find("0.5,"), 4, "1e-6,");
  EXPECT_THAT(load(small).notes, testing::Contains(AllOf(HasSubstr("1e-06 m wide"),
                                                         HasSubstr("metres_per_unit 1e-06"))));
}

TEST_F(SceneTest, TheModelsCamerasAndLightsAreTheDefault) {
  const SceneData scene = load(R"({"model": "models/model.gltf", "metres_per_unit": 2})");
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].name, "own");
  EXPECT_EQ(scene.cameras[0].eye, glm::vec3(0, 0, 16));
  EXPECT_EQ(scene.cameras[0].near_depth, 2);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].data.range, 8);
  EXPECT_THAT(scene.notes, IsEmpty());
}

TEST_F(SceneTest, AnEmptyListOfLightsMeansDarkness) {
  const SceneData scene = load(R"({"model": "models/model.gltf", "lights": []})");
  EXPECT_THAT(scene.lights, IsEmpty());
  EXPECT_THAT(scene.notes, IsEmpty());
}

TEST_F(SceneTest, TheModelCanBeReplaced) {
  GltfBuilder other;
  other.triangle();
  other.triangle();
  const SceneData scene = load(kFull, {other.write(folder, "other.gltf")});
  EXPECT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(load("{}", {folder / "other.gltf"}).triangles.size(), 2u)
      << "and need not be given at all";
}

TEST_F(SceneTest, ABareModelGetsACameraAndASun) {
  GltfBuilder bare;
  bare.mesh({{"POSITION", bare.accessor<float>("VEC3", {-3, 0, -1, 5, 0, 2, 0, 4, 1})}});
  const SceneData scene = load_scene(bare.write(folder));
  ASSERT_EQ(scene.cameras.size(), 1u);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].data.kind, static_cast<unsigned>(CLPV_LIGHT_DIRECTIONAL));
  EXPECT_LT(scene.lights[0].data.direction[1], -0.5f);
  EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("no camera"), HasSubstr("no light")));
  const SceneCamera& camera = scene.cameras[0];
  for (const Vertex& vertex : scene.vertices) {  // every corner is in view, in a square image
    const glm::vec3 d =
        glm::vec3(vertex.position[0], vertex.position[1], vertex.position[2]) - camera.eye;
    EXPECT_GT(glm::dot(d, camera.forward), camera.near_depth);
    EXPECT_GT(glm::dot(glm::normalize(d), camera.forward), std::cos(camera.vertical_fov / 2));
  }
}

// Cameras and lights of scene files that move by keys.

using ::testing::FloatNear;

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
}  // namespace clpv::test::scene_test
