// SPDX-License-Identifier: MIT
// glTF geometry, nodes, cameras and lights, feature by feature: each test writes a small model and
// checks the scene in world space.
#include <glm/gtc/constants.hpp>

#include "support/input_file.hpp"
#include "tests/support/gltf_builder.hpp"

namespace clpv::test::gltf_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(GltfTest, TransformsMultiplyDownTheHierarchy) {
  model.triangle();
  // The root turns by 90 degrees about z and moves; its child scales; the mesh is the grandchild's,
  // with a matrix.
  model.document["nodes"] = json::parse(R"([
    {"translation": [10, 0, 0], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "children": [1]},
    {"scale": [2, 2, 2], "children": [2]},
    {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,3,1], "mesh": 0}])");
  const SceneData scene = load();
  EXPECT_THAT(position(scene, 0, 0), IsNear(glm::vec3(10, 0, 6), 1e-5f));
  EXPECT_THAT(position(scene, 0, 1), IsNear(glm::vec3(10, 2, 6), 1e-5f));
  EXPECT_THAT(position(scene, 0, 2), IsNear(glm::vec3(8, 0, 6), 1e-5f));
}

TEST_F(GltfTest, OnlyTheDefaultSceneIsShown) {
  model.triangle();
  model.document["nodes"].push_back({{"mesh", 0}, {"translation", {5, 0, 0}}});
  model.document["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  const SceneData first = load();
  EXPECT_THAT(position(first, 0, 0), IsNear(glm::vec3(0), kClose));
  EXPECT_THAT(first.notes, ::testing::Contains("/scene: none of 2 scenes: /scenes/0 is shown"));
  model.document["scene"] = 1;
  const SceneData second = load();
  EXPECT_THAT(second.notes, ::testing::Not(::testing::Contains(HasSubstr("/scene"))));
  ASSERT_EQ(second.triangles.size(), 1u);
  EXPECT_THAT(position(second, 0, 0), IsNear(glm::vec3(5, 0, 0), kClose));
}

TEST_F(GltfTest, AMirroredMeshKeepsItsFront) {
  const int position = model.accessor<float>("VEC3", {0, 0, 1, 1, 0, 1, 0, 1, 1});
  const int normals = model.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  model.mesh({{"POSITION", position}, {"NORMAL", normals}});
  for (const glm::vec3 scale : {glm::vec3(-1, 1, 1), glm::vec3(1, 1, -1), glm::vec3(-2, -3, -1)}) {
    model.document["nodes"][0]["scale"] = {scale.x, scale.y, scale.z};
    const SceneData scene = load();
    const glm::vec3 outside = kZ * glm::sign(scale.z);  // away from the origin
    EXPECT_THAT(face_normal(scene, 0), IsNear(outside, kClose)) << scale.x << ' ' << scale.z;
    EXPECT_THAT(normal(scene, 0, 1), IsNear(outside, kClose)) << scale.x << ' ' << scale.z;
  }
}

TEST_F(GltfTest, NormalsTurnByTheInverseTranspose) {
  // A face of slope 45 degrees, y stretched by 3: its normal leans towards x.
  const int position = model.accessor<float>("VEC3", {0, 1, 0, 0, 1, 1, 1, 0, 0});
  const float h = std::sqrt(0.5f);
  const int normals = model.accessor<float>("VEC3", {h, h, 0, h, h, 0, h, h, 0});
  model.mesh({{"POSITION", position}, {"NORMAL", normals}});
  model.document["nodes"][0]["scale"] = {1, 3, 1};
  const SceneData scene = load();
  EXPECT_THAT(normal(scene, 0, 0), IsNear(glm::normalize(glm::vec3(3, 1, 0)), kClose));
  EXPECT_THAT(normal(scene, 0, 0), IsNear(face_normal(scene, 0), kClose));
}

TEST_F(GltfTest, AFlattenedNodeStillHasNormals) {
  model.triangle();
  model.document["nodes"][0]["scale"] = {1, 1, 0};
  EXPECT_THAT(normal(load(), 0, 0), IsNear(kZ, kClose));
}

TEST_F(GltfTest, IndicesOfEverySize) {
  const std::vector<float> square = {9, 9, 9, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const auto check = [&](auto type) {
    using T = decltype(type);
    GltfBuilder square_model;
    const int position = square_model.accessor<float>("VEC3", square);
    const int indices = square_model.accessor<T>("SCALAR", {1, 2, 3, 1, 3, 4});
    square_model.mesh({{"POSITION", position}}, {{"indices", indices}});
    const SceneData scene = load_scene(square_model.write(folder));
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_THAT(corners(scene, 1), ElementsAre(glm::vec3(0), glm::vec3(1, 1, 0), kY));
    EXPECT_EQ(scene.upper, glm::vec3(1, 1, 0)) << "an unused vertex counts";
  };
  check(std::uint8_t{});
  check(std::uint16_t{});
  check(std::uint32_t{});
}

TEST_F(GltfTest, SharedVerticesStayShared) {
  const int position = model.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  const int normals = model.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int indices = model.accessor<std::uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
  model.mesh({{"POSITION", position}, {"NORMAL", normals}}, {{"indices", indices}});
  EXPECT_EQ(load().vertices.size(), 4u);
}

TEST_F(GltfTest, StripsAndFansFaceOneWay) {
  // A 2 x 1 strip, and the same outline as a fan.
  const std::vector<float> strip = {0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0};
  const std::vector<float> fan = {0, 0, 0, 2, 0, 0, 1, 1, 0, 0, 1, 0};
  for (const int mode : {5, 6}) {
    GltfBuilder made;
    made.mesh({{"POSITION", made.accessor<float>("VEC3", mode == 5 ? strip : fan)}},
              {{"mode", mode}});
    const SceneData scene = load_scene(made.write(folder));
    ASSERT_EQ(scene.triangles.size(), mode == 5 ? 3u : 2u);
    const glm::vec3 first = face_normal(scene, 0);
    EXPECT_THAT(first, IsNear(mode == 5 ? -kZ : kZ, kClose));
    float area = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
      EXPECT_THAT(face_normal(scene, t), IsNear(first, kClose));
      const glm::vec3 a = position(scene, t, 0);
      area += glm::length(glm::cross(position(scene, t, 1) - a, position(scene, t, 2) - a)) / 2;
    }
    EXPECT_NEAR(area, 1.5f, kClose);
  }
}

TEST_F(GltfTest, SparseAccessorsReplaceElementsOfAViewOrOfZeros) {
  model.triangle();
  model.make_sparse(0, {0, 2}, {0, 0, 7, 0, 5, 7});
  EXPECT_THAT(corners(load(), 0), ElementsAre(glm::vec3(0, 0, 7), kX, glm::vec3(0, 5, 7)));
  model.document["accessors"][0].erase("bufferView");
  EXPECT_THAT(corners(load(), 0),
              ElementsAre(glm::vec3(0, 0, 7), glm::vec3(0), glm::vec3(0, 5, 7)));
}

TEST_F(GltfTest, MissingNormalsAreFlatAndSplitVertices) {
  // Two faces of a roof share their ridge.
  const int position = model.accessor<float>("VEC3", {0, 1, 0, 0, 1, 1, 1, 0, 0, -1, 0, 0});
  const int indices = model.accessor<std::uint8_t>("SCALAR", {0, 1, 2, 1, 0, 3});
  model.mesh({{"POSITION", position}}, {{"indices", indices}});
  const SceneData scene = load();
  EXPECT_EQ(scene.vertices.size(), 6u);
  for (std::size_t t = 0; t < 2; ++t) {
    for (int k = 0; k < 3; ++k)
      EXPECT_THAT(normal(scene, t, k), IsNear(face_normal(scene, t), kClose));
  }
  EXPECT_GT(normal(scene, 0, 0).x, 0.5f);
  EXPECT_LT(normal(scene, 1, 0).x, -0.5f);
}

TEST_F(GltfTest, ZeroNormalsTakeTheirTriangles) {
  const int position =
      model.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0});
  const int normals =
      model.accessor<float>("VEC3", {0, 0, 5, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  model.mesh({{"POSITION", position}, {"NORMAL", normals}});
  const SceneData scene = load();
  for (int k = 0; k < 3; ++k) EXPECT_THAT(normal(scene, 0, k), IsNear(kZ, kClose));
  EXPECT_NEAR(glm::length(normal(scene, 1, 0)), 1, kClose)
      << "a degenerate triangle has a finite normal too";
}

TEST_F(GltfTest, VertexColoursOfEveryFormat) {
  const auto colour = [&](auto values, const std::string& type, bool normalized) {
    GltfBuilder made;
    const int position = made.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int index = made.accessor(type, values, normalized);
    made.mesh({{"POSITION", position}, {"COLOR_0", index}});
    const SceneData scene = load_scene(made.write(folder));
    const float* c = scene.vertices[scene.triangles[0].vertex[1]].colour;
    return glm::vec4(c[0], c[1], c[2], c[3]);
  };
  const glm::vec4 wanted(0.2f, 0.4f, 0.6f, 0.8f), opaque(0.2f, 0.4f, 0.6f, 1);
  using Bytes = std::vector<std::uint8_t>;
  using Words = std::vector<std::uint16_t>;
  EXPECT_THAT(colour(std::vector<float>{0, 0, 0, 0.2f, 0.4f, 0.6f, 0, 0, 0}, "VEC3", false),
              IsNear(opaque, kClose));
  EXPECT_THAT(
      colour(std::vector<float>{0, 0, 0, 0, 0.2f, 0.4f, 0.6f, 0.8f, 0, 0, 0, 0}, "VEC4", false),
      IsNear(wanted, kClose));
  EXPECT_THAT(colour(Bytes{0, 0, 0, 0, 51, 102, 153, 204, 0, 0, 0, 0}, "VEC4", true),
              IsNear(wanted, kClose));
  EXPECT_THAT(colour(Words{0, 0, 0, 0, 13107, 26214, 39321, 52428, 0, 0, 0, 0}, "VEC4", true),
              IsNear(wanted, kClose));
  // They were once clamped to white.
  EXPECT_THAT(test::error_of(ExitCode::bad_input, [&] { colour(Bytes(12, 51), "VEC4", false); }),
              AllOf(HasSubstr("/attributes/COLOR_0"), HasSubstr("normalized integers")));
}

TEST_F(GltfTest, QuantizedAttributes) {
  model.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int view =
      model.view(bytes_of<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0}), 8);
  const int position = model.add("accessors", {{"bufferView", view},
                                               {"componentType", 5122},
                                               {"count", 3},
                                               {"type", "VEC3"},
                                               {"normalized", true}});
  const int normal_view =
      model.view(bytes_of<std::int8_t>({0, 0, -127, 0, 0, 0, -127, 0, 0, 0, -127, 0}), 4);
  const int normals = model.add("accessors", {{"bufferView", normal_view},
                                              {"componentType", 5120},
                                              {"count", 3},
                                              {"type", "VEC3"},
                                              {"normalized", true}});
  const int uv_index = model.accessor<std::uint16_t>("VEC2", {0, 0, 2, 0, 0, 3});
  textured(kPngGrey);
  model.mesh({{"POSITION", position}, {"NORMAL", normals}, {"TEXCOORD_0", uv_index}},
             {{"material", 0}});
  model.document["nodes"][0]["scale"] = {10, 10, 10};
  const SceneData scene = load();
  EXPECT_THAT(corners(scene, 0),
              ElementsAre(glm::vec3(0), glm::vec3(10, 0, 0), glm::vec3(0, -10, 0)));
  EXPECT_THAT(normal(scene, 0, 0), IsNear(-kZ, kClose));
  EXPECT_EQ(uv(scene, 2), glm::vec2(0, 3));
}

TEST_F(GltfTest, PointsAndLinesGetANote) {
  model.triangle();
  model.triangle({{"mode", 0}});
  model.triangle({{"mode", 3}});
  const SceneData scene = load();
  EXPECT_EQ(scene.triangles.size(), 1u);
  EXPECT_THAT(scene.notes,
              ::testing::Contains(HasSubstr("/meshes/1/primitives/0: made of points")));
  EXPECT_THAT(scene.notes, ::testing::Contains(HasSubstr("/meshes/2/primitives/0: made of lines")));
}

TEST_F(GltfTest, CamerasLookAlongMinusZ) {
  model.triangle();
  model.document["cameras"] = json::parse(R"([
    {"name": "wide", "type": "perspective", "perspective": {"yfov": 1.5, "znear": 0.25}},
    {"name": "flat", "type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 0}}])");
  model.add("nodes", json::parse(R"({"camera": 0, "translation": [1, 2, 3], "scale": [5, 5, 5],
                                     "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476]})"));
  model.add("nodes", {{"camera", 0}});
  model.add("nodes", {{"camera", 1}});
  const SceneData scene = load();
  ASSERT_EQ(scene.cameras.size(), 2u);
  const SceneCamera& camera = scene.camera("wide");
  EXPECT_THAT(camera.eye, IsNear(glm::vec3(1, 2, 3), kClose));
  EXPECT_THAT(camera.forward, IsNear(-kX, kClose));
  EXPECT_THAT(camera.up, IsNear(kY, kClose));
  EXPECT_EQ(camera.vertical_fov, 1.5f);
  EXPECT_EQ(camera.near_depth, 0.25f);
  EXPECT_EQ(scene.cameras[1].name, "wide 2") << "names are unique";
  EXPECT_THAT(scene.notes, ::testing::Contains(HasSubstr("/cameras/1 ('flat') is orthographic")));
}

TEST_F(GltfTest, PunctualLights) {
  model.triangle();
  model.document["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(R"([
    {"name": "sun", "type": "directional", "intensity": 100, "color": [1, 0.5, 0]},
    {"name": "lamp", "type": "point", "intensity": 40, "range": 6},
    {"name": "torch", "type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}}])");
  model.document["extensionsRequired"] = {"KHR_lights_punctual"};
  for (int i = 0; i < 3; ++i) {
    model.add("nodes",
              {{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}},
               {"translation", {0, i, 0}},
               {"rotation", {-0.7071067811865476, 0, 0, 0.7071067811865476}}});  // -z turns to -y
  }
  const SceneData scene = load();
  ASSERT_EQ(scene.lights.size(), 3u);
  const ClpvLight& sun = scene.lights[0].data;
  EXPECT_EQ(sun.kind, static_cast<unsigned>(CLPV_LIGHT_DIRECTIONAL));
  EXPECT_THAT(glm::vec3(sun.direction[0], sun.direction[1], sun.direction[2]), IsNear(-kY, kClose));
  EXPECT_THAT(sun.intensity, ElementsAre(100, 50, 0));
  const ClpvLight& lamp = scene.lights[1].data;
  EXPECT_EQ(lamp.kind, static_cast<unsigned>(CLPV_LIGHT_POINT));
  EXPECT_THAT(lamp.position, ElementsAre(0, 1, 0));
  EXPECT_EQ(lamp.range, 6);
  EXPECT_THAT(lamp.intensity, ElementsAre(40, 40, 40));
  const ClpvLight& torch = scene.lights[2].data;
  EXPECT_EQ(torch.kind, static_cast<unsigned>(CLPV_LIGHT_SPOT));
  EXPECT_EQ(torch.range, 0) << "unlimited";
  // The cone's edges, by the attenuation's own formula.
  EXPECT_NEAR(std::cos(0.25f) * torch.cone_scale + torch.cone_offset, 1, 1e-4);
  EXPECT_NEAR(std::cos(0.5f) * torch.cone_scale + torch.cone_offset, 0, 1e-4);
  EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("no camera")));
}

TEST_F(GltfTest, CamerasAndLightsIgnoreTheScaleOfTheirNode) {
  model.triangle();
  model.document["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  model.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}};
  const json node = {{"camera", 0},
                     {"translation", {1, 2, 3}},
                     {"rotation", {0, 0.7071067811865476, 0, 0.7071067811865476}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
  for (const json& scale :
       std::vector<json>{{1, 1, 1}, {2, 3, 4}, {-1, 1, 1}, {1, -2, 1}, {1, 1, -1}, {-1, -1, -1}}) {
    model.document["nodes"][1] = node;
    model.document["nodes"][1]["scale"] = scale;
    const SceneData scene = load();
    EXPECT_THAT(scene.cameras.at(0).eye, IsNear(glm::vec3(1, 2, 3), kClose)) << scale;
    EXPECT_THAT(scene.cameras.at(0).forward, IsNear(-kX, kClose)) << scale;
    EXPECT_THAT(scene.cameras.at(0).up, IsNear(kY, kClose)) << scale;
    EXPECT_THAT(glm::vec3(vector(scene.lights.at(0).data.direction)), IsNear(-kX, kClose)) << scale;
  }
}

TEST_F(GltfTest, SharedNamesOfCamerasAndLightsGetANote) {
  model.triangle();
  model.document["cameras"] = {
      {{"name", "wide"}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  model.document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"name", "lamp"}, {"type", "point"}}, {{"name", "sun"}, {"type", "directional"}}};
  const auto light = [](int index) {
    return json{{"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}};
  };
  for (int i = 0; i < 2; ++i) model.add("nodes", {{"camera", 0}});
  for (int i = 0; i < 3; ++i) model.add("nodes", light(0));
  model.add("nodes", light(1));
  const SceneData scene = load();
  EXPECT_EQ(scene.camera("wide 2").name, "wide 2");
  EXPECT_THAT(
      scene.notes,
      ElementsAre("2 cameras have the name 'wide': the second is called 'wide 2'",
                  "3 lights have the name 'lamp': the others are called 'lamp 2' and so on"));
}

TEST_F(GltfTest, NamesOfTheFileAreNotMadeUpForOthers) {
  model.triangle();
  for (const char* name : {"wide", "wide 2", "camera 2"}) {
    model.document["cameras"].push_back(
        {{"name", name}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  }
  model.document["cameras"].push_back(
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  for (const int camera : {0, 0, 3, 3, 1, 2})
    model.add("nodes", {{"camera", camera}, {"translation", {static_cast<double>(camera), 0, 0}}});
  const SceneData scene = load();
  EXPECT_EQ(scene.camera("wide 2").eye.x, 1);
  EXPECT_EQ(scene.camera("wide 3").eye.x, 0);
  EXPECT_EQ(scene.camera("camera 2").eye.x, 2);
}

TEST_F(GltfTest, InstancesAreDrawn) {
  const float h = std::sqrt(0.5f);
  model.triangle();
  model.document["nodes"][0]["translation"] = {0, 0, 10};
  model.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  json& attributes =
      model.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes = {{"TRANSLATION", model.accessor<float>("VEC3", {0, 0, 0, 5, 0, 0})},
                {"ROTATION", model.accessor<float>("VEC4", {0, 0, 0, 1, 0, 0, h, h})},
                {"SCALE", model.accessor<float>("VEC3", {1, 1, 1, 2, 3, 1})}};
  const SceneData scene = load();
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_THAT(corners(scene, 0),
              ElementsAre(glm::vec3(0, 0, 10), glm::vec3(1, 0, 10), glm::vec3(0, 1, 10)));
  // Scaled, then turned by 90 degrees about z, then moved; the node moves all.
  EXPECT_THAT(position(scene, 1, 0), IsNear(glm::vec3(5, 0, 10), 1e-5f));
  EXPECT_THAT(position(scene, 1, 1), IsNear(glm::vec3(5, 2, 10), 1e-5f));
  EXPECT_THAT(position(scene, 1, 2), IsNear(glm::vec3(2, 0, 10), 1e-5f));
  EXPECT_THAT(scene.notes, ::testing::Not(::testing::Contains(HasSubstr("not read"))));

  attributes = {{"SCALE", model.accessor<float>("VEC3", {-1, 1, 1})},
                {"_COLOR_0", model.accessor<float>("VEC3", {1, 0, 0})}};
  const SceneData mirrored = load();
  EXPECT_THAT(corners(mirrored, 0),
              ElementsAre(glm::vec3(0, 0, 10), glm::vec3(0, 1, 10), glm::vec3(-1, 0, 10)));
  EXPECT_THAT(face_normal(mirrored, 0), IsNear(kZ, kClose)) << "its front stays outside";
  EXPECT_THAT(mirrored.notes, ::testing::Contains(HasSubstr("not read: _COLOR_0")));

  attributes = {{"ROTATION", model.accessor<std::int8_t>("VEC4", {0, 0, 127, 0}, true)}};
  EXPECT_THAT(position(load(), 0, 1), IsNear(glm::vec3(-1, 0, 10), 1e-5f));
}

TEST_F(AnimationTest, InstancesMoveWithTheirNode) {
  model.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      model.accessor<float>("VEC3", {0, 0, 0, 5, 0, 0});
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 0, 2, 0});
  MovingScene moving = load();
  moving.pose(0.5);
  EXPECT_THAT(position(moving.scene(), 0, 0), IsNear(glm::vec3(0, 1, 0), kClose));
  EXPECT_THAT(position(moving.scene(), 1, 0), IsNear(glm::vec3(5, 1, 0), kClose));
}

TEST_F(GltfTest, DataUrisOfEverySpelling) {
  model.triangle();
  model.finish("");
  const std::string base64 = encode_base64(model.binary);
  std::string percent, escaped;
  for (const char c : model.binary)
    percent += fmt::format("%{:02x}", static_cast<unsigned char>(c));
  for (const char c : base64)
    escaped += c == '=' || c == '+' || c == '/'
                   ? fmt::format("%{:02X}", static_cast<unsigned char>(c))
                   : std::string(1, c);
  for (const std::string& uri :
       {"data:application/octet-stream;base64," + base64,
        "data:application/gltf-buffer;base64," + base64, "data:;base64," + base64,
        "DATA:Application/Octet-Stream;BASE64," + base64,
        "data:text/plain;charset=utf-8;base64," + base64, "data:model/gltf-binary;base64," + base64,
        "data:;base64," + base64.substr(0, base64.find('=')), "data:;base64," + escaped,
        "data:application/octet-stream," + percent}) {
    model.document["buffers"][0]["uri"] = uri;
    const SceneData scene = load_scene(folder.write("model.gltf", model.document.dump()));
    EXPECT_THAT(corners(scene, 0), ElementsAre(glm::vec3(0), kX, kY)) << uri;
  }
}

TEST_F(GltfTest, FilesOfEncodedUrisAreInputs) {
  model.triangle();
  model.finish("the%20buffer.bin");
  folder.write("the buffer.bin", model.binary);
  const InputRecord record;
  load_scene(folder.write("model.gltf", model.document.dump()));
  EXPECT_TRUE(InputRecord::find(identity_of(folder.path() / "the buffer.bin")));
}

TEST_F(GltfTest, LightsByBlenderThatLookPhotometricGetANote) {
  model.triangle();
  model.document["asset"]["generator"] = "Khronos glTF Blender I/O v4.2.57";
  model.document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 683}, {"color", {1, 0.9, 0.8}}}};
  model.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const auto note = ::testing::Contains(AllOf(HasSubstr("683"), HasSubstr("0.001464")));
  EXPECT_THAT(load().notes, note);
  MovingScene scaled(model.write(folder));
  scaled.set_light_scale(1.0 / 683);
  EXPECT_THAT(scaled.scene().notes, ::testing::Not(note));
  EXPECT_THAT(scaled.scene().lights_for(scaled.scene().cameras[0]).at(0).data.intensity,
              ElementsAre(::testing::FloatNear(1, 1e-6f), ::testing::FloatNear(0.9f, 1e-6f),
                          ::testing::FloatNear(0.8f, 1e-6f)));
  model.document["asset"]["generator"] = "another";
  EXPECT_THAT(load().notes, ::testing::Not(note));
  model.document["asset"]["generator"] = "Khronos glTF Blender I/O v4.2.57";
  model.document["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 5;
  EXPECT_THAT(load().notes, ::testing::Not(note));
}

TEST_F(GltfTest, ExtensionsThatAreNotReadGetANote) {
  model.triangle();
  const auto note = ::testing::Contains("extensions that are not read: KHR_materials_unlit");
  model.document["extensionsUsed"] = {"KHR_materials_unlit", "KHR_mesh_quantization"};
  EXPECT_THAT(load().notes, note);
  model.document.erase("extensionsUsed");
  model.document["nodes"][0]["extras"]["extensions"]["a"] = 1;
  EXPECT_THAT(load().notes, ::testing::Not(::testing::Contains(HasSubstr("extensions"))));
  model.document["nodes"][0]["extensions"]["KHR_materials_unlit"] = json::object();
  EXPECT_THAT(load().notes, note) << "which extensionsUsed does not list";
  const int times = model.accessor<float>("SCALAR", {0, 1});
  model.document["animations"] = {
      {{"samplers", {{{"input", times}, {"output", times}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"path", "pointer"}}}}}}}};
  EXPECT_THAT(load().notes, ::testing::Contains(HasSubstr("KHR_animation_pointer")));
}

}  // namespace
}  // namespace clpv::test::gltf_test
