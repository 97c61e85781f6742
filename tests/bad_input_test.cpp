// SPDX-License-Identifier: MIT
// Hostile and broken files, JSON, URIs and scene files, one a test: each is refused with file, place, value found and value
// allowed, as exit code 3 (bad_input).
#include "tests/support/bad_input.hpp"

namespace clpv::test::bad_input_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST_F(BadInputTest, MissingFile) {
  EXPECT_THAT(refusal(folder / "none.gltf"), AllOf(HasSubstr("none.gltf"), HasSubstr("no file")));
  EXPECT_THAT(refusal(folder / "none.json"), HasSubstr("no file"));
}

TEST_F(BadInputTest, AFolderForAFile) {
  std::filesystem::create_directories(folder / "folder.gltf");
  EXPECT_THAT(refusal(folder / "folder.gltf"), HasSubstr("a folder"));
}

TEST_F(BadInputTest, UnknownExtension) {
  EXPECT_THAT(refusal(folder.write("model.obj", "")), AllOf(HasSubstr("'.obj'"), HasSubstr(".json")));
}

TEST_F(BadInputTest, EmptyFiles) {
  for (const char* name : {"empty.gltf", "empty.glb", "empty.json"}) {
    EXPECT_THAT(refusal(folder.write(name, "")), HasSubstr("no JSON"));
  }
}

TEST_F(BadInputTest, TruncatedGlbAtAnyLength) {
  const std::string whole = model.glb();
  ASSERT_EQ(load_scene(folder.write("whole.glb", whole)).triangles.size(), 1u);
  for (std::size_t length = 4; length < whole.size(); length += 5) {
    EXPECT_NE(refusal(folder.write("cut.glb", whole.substr(0, length))), "") << length;
  }
  EXPECT_THAT(refusal(folder.write("cut.glb", whole.substr(0, 40))),
              AllOf(HasSubstr("40 bytes"), HasSubstr("truncated")));
}

TEST_F(BadInputTest, GlbChunksThatLeaveTheFile) {
  std::string glb = model.glb();
  const std::uint32_t huge = 0xfffffff0u;
  std::memcpy(&glb[12], &huge, 4);
  EXPECT_THAT(refusal(folder.write("bad.glb", glb)), AllOf(HasSubstr("4294967280"), HasSubstr("chunk")));
}

TEST_F(BadInputTest, GlbOfAnotherVersionOrOrder) {
  std::string glb = model.glb();
  glb[4] = 1;
  EXPECT_THAT(refusal(folder.write("bad.glb", glb)), HasSubstr("version 1"));
  glb[4] = 2;
  glb[16] = 'X';
  EXPECT_THAT(refusal(folder.write("bad.glb", glb)), HasSubstr("first .glb chunk"));
}

TEST_F(BadInputTest, JsonNestedAHundredThousandDeep) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  for (const char* name : {"deep.gltf", "deep.json"}) {
    EXPECT_THAT(refusal(folder.write(name, deep)), AllOf(HasSubstr("nested"), HasSubstr("64")));
  }
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += R"({"extras":)";
  EXPECT_THAT(refusal(folder.write("deep.gltf", objects)), HasSubstr("nested"));
}

TEST_F(BadInputTest, BracketsInStringsAreNotNesting) {
  model.document["asset"]["generator"] = std::string(1000, '[') + "\\\"{";
  EXPECT_EQ(load_scene(model.write(folder)).triangles.size(), 1u);
}

TEST_F(BadInputTest, TooManyJsonValues) {
  std::string text = "[0";
  for (std::uint64_t i = 0; i <= bounds::kJsonValues; ++i) text += ",0";
  EXPECT_THAT(refusal(folder.write("many.gltf", text + "]")), HasSubstr("JSON values"));
}

TEST_F(BadInputTest, SyntaxErrorsNameTheLine) {
  EXPECT_THAT(refusal(folder.write("bad.gltf", "{\n\"asset\": {,}\n}")),
              AllOf(HasSubstr("line 2"), HasSubstr("bad.gltf")));
  EXPECT_THAT(refusal(folder.write("bad.gltf", "{\"asset\": 1e999}")), HasSubstr("1e999"));
  EXPECT_THAT(refusal(folder.write("bad.gltf", "{\"asset\": \"\xff\xfe\"}")), HasSubstr("no JSON"));
  EXPECT_THAT(refusal(folder.write("bad.gltf", "[]")), HasSubstr("an object"));
}

TEST_F(BadInputTest, NoAssetOrAnotherVersion) {
  model.document["asset"]["version"] = "1.0";
  EXPECT_THAT(refused(), AllOf(HasSubstr("/asset/version"), HasSubstr("1.0"), HasSubstr("2.x")));
  model.document.erase("asset");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/asset"), HasSubstr("nothing")));
}

TEST_F(BadInputTest, WrongTypes) {
  model.document["materials"] = {{{"doubleSided", "yes"}}};
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/materials/0/doubleSided"), HasSubstr("\"yes\""), HasSubstr("true or false")));
  model.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, "red", 1}}}}}};
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/materials/0/pbrMetallicRoughness/baseColorFactor"), HasSubstr("\"red\"")));
  model.document["materials"] = 7;
  EXPECT_THAT(refused(), AllOf(HasSubstr("/materials"), HasSubstr("found 7"), HasSubstr("an array")));
}

TEST_F(BadInputTest, RequiredExtensionsAreRefusedByName) {
  model.document["extensionsRequired"] = {"KHR_texture_transform", "KHR_draco_mesh_compression"};
  EXPECT_THAT(refused(), AllOf(HasSubstr("/extensionsRequired/1"), HasSubstr("'KHR_draco_mesh_compression'"),
                               HasSubstr("KHR_lights_punctual")));
}

TEST_F(BadInputTest, UrisThatLeaveTheFolder) {
  const std::string secret = decode_base64(kPngGrey);
  folder.write("secret.png", secret);
  folder.write("in/here.png", secret);
  std::filesystem::create_symlink(folder / "secret.png", folder / "in/link.png");
  std::filesystem::create_symlink(folder.path(), folder / "in/out");
  std::filesystem::create_symlink(folder / "in/here.png", folder / "in/inner.png");
  const std::string absolute = (folder / "secret.png").string();
  model.finish("model.bin");
  folder.write("in/model.bin", model.binary);
  const auto load_with = [&](const std::string& uri) {
    const GltfBuilder sound = model;
    wear(uri);
    model.finish("model.bin");
    folder.write("in/model.bin", model.binary);
    const auto path = folder.write("in/model.gltf", model.document.dump());
    model = sound;
    return path;
  };
  EXPECT_EQ(load_scene(load_with("here.png")).textures.size(), 1u);
  EXPECT_EQ(load_scene(load_with("../in/here.png")).textures.size(), 1u) << "it comes back";
  EXPECT_EQ(load_scene(load_with("inner.png")).textures.size(), 1u) << "a link that stays inside";
  for (const std::string& uri :
       {std::string("../secret.png"), std::string("%2e%2e/secret.png"), std::string("%2E%2E%2Fsecret.png"),
        std::string("..\\secret.png"), std::string("./../secret.png"),
        std::string("here.png/../../secret.png"), absolute, "//" + absolute, "file://" + absolute,
        std::string("http://localhost/secret.png"), std::string("C:secret.png"), std::string("link.png"),
        std::string("out/secret.png"), std::string("."), std::string(""), std::string("none.png"),
        std::string("here.png%00"), std::string("%zz")}) {
    const std::string message = refusal(load_with(uri));
    EXPECT_THAT(message, AllOf(HasSubstr("/images/0/uri"), HasSubstr("allowed: a relative path"))) << uri;
  }
}

TEST_F(BadInputTest, BufferUrisThatLeaveTheFolder) {
  folder.write("model.bin", model.binary);
  std::filesystem::create_directories(folder / "in/folder");
  for (const char* uri :
       {"../model.bin", "%2e%2e/model.bin", "/etc/passwd", "folder", "file:///etc/passwd"}) {
    model.finish(uri);
    EXPECT_THAT(refusal(folder.write("in/model.gltf", model.document.dump())),
                AllOf(HasSubstr("/buffers/0/uri"), HasSubstr(uri)));
  }
}

TEST_F(BadInputTest, DevicesAreNotRead) {
  std::filesystem::create_symlink("/dev/zero", folder / "zero.gltf");
  EXPECT_THAT(refusal(folder / "zero.gltf"), HasSubstr("no regular file"));
}

struct BadSceneFileTest : BadInputTest {
  std::string refused_file(const std::string& text) {
    model.write(folder);
    const std::string message = refusal(folder.write("scene.json", text));
    EXPECT_THAT(message, HasSubstr("scene.json"));
    return message;
  }
};

TEST_F(BadSceneFileTest, UnknownKeysAreNamedWithThoseAllowed) {
  EXPECT_THAT(refused_file(R"({"model": "model.gltf", "exposre": 1})"),
              AllOf(HasSubstr("/exposre"), HasSubstr("unknown key"), HasSubstr("exposure"),
                    HasSubstr("metres_per_unit")));
  EXPECT_THAT(
      refused_file(
          R"({"model": "model.gltf", "cameras": [{"name": "a", "eye": [0,0,0], "target": [1,0,0], "fov": 3}]})"),
      AllOf(HasSubstr("/cameras/0/fov"), HasSubstr("vertical_fov_degrees")));
  EXPECT_THAT(refused_file(R"({"model": "model.gltf", "cascades": {"size": 3}})"),
              AllOf(HasSubstr("/cascades/size"), HasSubstr("size_metres")));
}

TEST_F(BadSceneFileTest, KeysOfAnotherKindOfLight) {
  EXPECT_THAT(
      refused_file(
          R"({"model": "model.gltf", "lights": [{"kind": "point", "position": [0,0,0], "intensity_candela": 1,
                               "direction": [0,0,1]}]})"),
      AllOf(HasSubstr("/lights/0/direction"), HasSubstr("point light")));
  EXPECT_THAT(
      refused_file(R"({"model": "model.gltf", "lights": [{"kind": "directional", "direction": [0,0,1]}]})"),
      AllOf(HasSubstr("/lights/0/illuminance_lux"), HasSubstr("needs it")));
  EXPECT_THAT(refused_file(R"({"model": "model.gltf", "lights": [{"kind": "sun"}]})"),
              AllOf(HasSubstr("/lights/0/kind"), HasSubstr("directional, spot, point")));
}

TEST_F(BadSceneFileTest, ValuesOutOfRange) {
  EXPECT_THAT(refused_file(R"({"model": "model.gltf", "metres_per_unit": 0})"),
              AllOf(HasSubstr("/metres_per_unit"), HasSubstr("found 0")));
  EXPECT_THAT(refused_file(R"({"model": "model.gltf", "metres_per_unit": "big"})"),
              HasSubstr("/metres_per_unit"));
  EXPECT_THAT(refused_file(R"({"model": "model.gltf", "cascades": {"count": 0}})"),
              HasSubstr("/cascades/count"));
  EXPECT_THAT(
      refused_file(R"({"model": "model.gltf", "cameras": [{"name": "a", "eye": [0,0], "target": [1,0,0]}]})"),
      AllOf(HasSubstr("/cameras/0/eye"), HasSubstr("an array of 2"), HasSubstr("3 numbers")));
}

TEST_F(BadSceneFileTest, GeometryThatMakesNoView) {
  EXPECT_THAT(
      refused_file(
          R"({"model": "model.gltf", "cameras": [{"name": "a", "eye": [1,0,0], "target": [1,0,0]}]})"),
      AllOf(HasSubstr("/cameras/0/target"), HasSubstr("the eye itself")));
  EXPECT_THAT(
      refused_file(
          R"({"model": "model.gltf", "cameras": [{"name": "a", "eye": [0,5,0], "target": [0,0,0]}]})"),
      AllOf(HasSubstr("/cameras/0/up"), HasSubstr("across the line of sight")));
  EXPECT_THAT(
      refused_file(
          R"({"model": "model.gltf", "lights": [{"kind": "directional", "direction": [0,0,0], "illuminance_lux": 1}]})"),
      AllOf(HasSubstr("/lights/0/direction"), HasSubstr("no length")));
  EXPECT_THAT(
      refused_file(
          R"({"model": "model.gltf", "lights": [{"kind": "spot", "position": [0,0,0], "direction": [0,0,1],
                               "intensity_candela": 1, "inner_cone_degrees": 50, "outer_cone_degrees": 40}]})"),
      AllOf(HasSubstr("/lights/0"), HasSubstr("inner less than outer")));
}

TEST_F(BadSceneFileTest, NamesTwiceOrOfNothing) {
  EXPECT_THAT(
      refused_file(R"({"model": "model.gltf", "cameras": [{"name": "a", "eye": [0,0,0], "target": [1,0,0]},
                                                                  {"name": "a", "eye": [0,0,0], "target": [1,0,0]}]})"),
      AllOf(HasSubstr("/cameras/1/name"), HasSubstr("'a' again")));
  EXPECT_THAT(
      refused_file(
          R"({"model": "model.gltf", "cameras": [{"name": "a", "eye": [0,0,0], "target": [1,0,0], "light": "moon"}],
                               "lights": [{"name": "sun", "kind": "directional", "direction": [0,-1,0], "illuminance_lux": 1}]})"),
      AllOf(HasSubstr("/cameras/0/light"), HasSubstr("'moon'"), HasSubstr("'sun'")));
}

TEST_F(BadSceneFileTest, AModelThatIsNotThere) {
  EXPECT_THAT(refused_file(R"({"model": "absent.gltf"})"),
              AllOf(HasSubstr("/model"), HasSubstr("absent.gltf"), HasSubstr("option model")));
  EXPECT_THAT(refused_file("{}"), AllOf(HasSubstr("/model"), HasSubstr("nothing")));
}

}  // namespace
}  // namespace clpv::test::bad_input_test
