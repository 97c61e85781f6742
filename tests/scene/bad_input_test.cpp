// SPDX-License-Identifier: MIT
// Hostile and broken files, JSON, containers, URIs and scene files: each is rejected with file,
// place, value found and value allowed, as exit code 3 (bad_input).

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/compare.hpp"
#include "image/image_io.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::bad_input_test {

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST_F(BadInputTest, Files) {
  std::filesystem::create_directories(folder / "folder.gltf");
  std::filesystem::create_symlink("/dev/zero", folder / "zero.gltf");
  EXPECT_THAT(rejection(folder / "none.gltf"), AllOf(HasSubstr("none.gltf"), HasSubstr("no file")));
  EXPECT_THAT(rejection(folder / "none.json"), HasSubstr("no file"));
  EXPECT_THAT(rejection(folder / "folder.gltf"), HasSubstr("a folder"));
  EXPECT_THAT(rejection(folder / "zero.gltf"), HasSubstr("not a regular file"));
  EXPECT_THAT(rejection(folder.write("model.obj", "")),
              AllOf(HasSubstr("'.obj'"), HasSubstr(".json")));
}

TEST_F(BadInputTest, TextsThatAreNoJson) {
  std::string objects, many = "[0";
  for (int i = 0; i < 100000; ++i) objects += R"({"extras":)";
  for (std::uint64_t i = 0; i <= bounds::kJsonValues; ++i) many += ",0";
  const std::string deep = std::string(100000, '[') + std::string(100000, ']'), zeros(4096, '\0');
  const std::pair<std::string, const char*> texts[] = {
      {"", "invalid JSON"},
      {R"({"cameras": [{"eye": [0, 0, 0], "eye": [1, 1, 1]}]})", "duplicate key \"eye\""},
      {zeros, "invalid JSON"},
      {std::string("\xff\xfe{\0}\0", 6), "invalid JSON"},
      {"{\"asset\": \"\xff\xfe\"}", "UTF-8"},
      {"{}{}", "invalid JSON"},
      {"{\n\"asset\": {,}\n}", "line 2"},
      {"{\"asset\": 1e999}", "1e999"},
      {deep, "nested more than 64"},
      {objects, "nested"},
      {many + "]", "JSON values"},
      {"[]", "an object"},
  };
  for (const auto& [text, word] : texts) {
    for (const char* name : {"bad.gltf", "bad.json"})
      EXPECT_THAT(rejection(folder.write(name, text)), AllOf(HasSubstr(name), HasSubstr(word)));
  }
  model.document["asset"]["generator"] =
      std::string(1000, '[') + "\\\"{";  // brackets in texts are not nesting
  EXPECT_EQ(load_scene(model.write(folder)).triangles.size(), 1u);
}

TEST_F(BadInputTest, TruncatedGlbAtAnyLength) {
  const std::string whole = model.glb();
  ASSERT_EQ(load_scene(folder.write("whole.glb", whole)).triangles.size(), 1u);
  for (std::size_t length = 4; length < whole.size(); length += 5) {
    EXPECT_NE(rejection(folder.write("cut.glb", whole.substr(0, length))), "") << length;
  }
  EXPECT_THAT(rejection(folder.write("cut.glb", whole.substr(0, 40))),
              AllOf(HasSubstr("40 bytes"), HasSubstr("truncated")));
}

TEST_F(BadInputTest, GlbHeadersAndChunks) {
  const std::string sound = model.glb();
  const auto rejected_with = [&](std::size_t at, std::uint32_t word) {
    std::string glb = sound;
    std::memcpy(&glb[at], &word, sizeof word);
    return rejection(folder.write("bad.glb", glb));
  };
  std::uint32_t text = 0, binary = 0;
  std::memcpy(&text, &sound[12], sizeof text);
  std::memcpy(&binary, &sound[20 + text], sizeof binary);
  EXPECT_THAT(rejected_with(4, 1), HasSubstr("version 1"));
  EXPECT_THAT(rejected_with(8, 4000), AllOf(HasSubstr("4000"), HasSubstr("truncated")));
  EXPECT_THAT(rejected_with(8, 12), HasSubstr("truncated"));
  EXPECT_THAT(rejected_with(12, 0xfffffff0u), HasSubstr("4294967280"));
  EXPECT_THAT(rejected_with(16, 0x004e4942), HasSubstr("a first .glb chunk"));
  EXPECT_THAT(rejected_with(20 + text, binary + 8), HasSubstr("a second .glb chunk"));
  EXPECT_THAT(rejected_with(20 + text, binary - 4), HasSubstr("byteLength"));
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
  EXPECT_EQ(load_scene(load_with("inner.png")).textures.size(), 1u) << "a link that stays inside";
  for (const std::string& uri :
       {std::string("../secret.png"), std::string("../in/here.png"),
        (folder / "in/here.png").string(), std::string("%2e%2e/secret.png"),
        std::string("..\\secret.png"), std::string("here.png/../../secret.png"), absolute,
        "//" + absolute, "file://" + absolute, std::string("http://localhost/secret.png"),
        std::string("C:secret.png"), std::string("link.png"), std::string("out/secret.png"),
        std::string("."), std::string(""), std::string("none.png"), std::string("here.png%00"),
        std::string("%zz")}) {
    const std::string message = rejection(load_with(uri));
    EXPECT_THAT(message, AllOf(HasSubstr("/images/0/uri"), HasSubstr("allowed: a relative path")))
        << uri;
  }
}

TEST_F(BadInputTest, BufferUrisThatLeaveTheFolder) {
  folder.write("model.bin", model.binary);
  std::filesystem::create_directories(folder / "in/folder");
  for (const char* uri :
       {"../model.bin", "%2e%2e/model.bin", "/etc/passwd", "folder", "file:///etc/passwd"}) {
    model.finish(uri);
    EXPECT_THAT(rejection(folder.write("in/model.gltf", model.document.dump())),
                AllOf(HasSubstr("/buffers/0/uri"), HasSubstr(uri)));
  }
}

/// Scene files: each rejected with place, value found and value allowed.
struct BadSceneFileTest : BadInputTest {
  BadSceneFileTest() { model.write(folder); }

  void expect_rejected(const std::string& members, const std::vector<std::string>& words) {
    const std::string text = "{" + members + "}",
                      message = rejection(folder.write("scene.json", text));
    EXPECT_THAT(message, HasSubstr("scene.json"));
    for (const std::string& word : words) EXPECT_THAT(message, HasSubstr(word)) << text;
  }
  /// Each row's members between `before` and `after`, in a scene of a sound model.
  void expect_rows(const std::string& before, const std::string& after,
                   const std::vector<std::pair<std::string, std::vector<std::string>>>& rows) {
    for (const auto& [members, words] : rows)
      expect_rejected(R"("model": "model.gltf", )" + before + members + after, words);
  }
};

TEST_F(BadSceneFileTest, EachMember) {
  expect_rows(
      "", "",
      {
          {R"("exposre": 1)", {"/exposre", "unknown key; allowed: cameras", "metres_per_unit"}},
          {R"("cascades": {"size": 3})", {"/cascades/size", "size_metres"}},
          {R"("metres_per_unit": 0)", {"/metres_per_unit", "found 0"}},
          {R"("exposure": 100)", {"/exposure", "-64 to 64"}},
          {R"("light_scale": 0)", {"/light_scale", "1e-06 to 1000000"}},
          {R"("cascades": {"count": 0})", {"/cascades/count"}},
          {R"("cascades": {"count": 1.5})", {"/cascades/count"}},
      });
  expect_rejected("", {"/model", "nothing"});
  expect_rejected(R"("model": 7)", {"/model", "found 7"});
  expect_rejected(R"("model": "absent.gltf")", {"/model", "absent.gltf", "option model"});
  expect_rejected(R"("model": "scene.json")", {"/asset"});
}

TEST_F(BadSceneFileTest, Cameras) {
  const json sound = {{"name", "a"}, {"eye", {0, 0, 0}}, {"target", {1, 0, 0}}};
  const auto expect_camera_rejected = [&](const json& cameras,
                                          const std::vector<std::string>& words) {
    expect_rejected(
        R"("model": "model.gltf", "lights": [{"name": "sun", "kind": "directional",
           "direction": [0, -1, 0], "illuminance_lux": 1}], "cameras": )" +
            cameras.dump(),
        words);
  };
  const std::vector<std::pair<std::string, std::vector<std::string>>> changes = {
      {R"("fov": 3)", {"/cameras/0/fov", "vertical_fov_degrees"}},
      {R"("eye": [0, 0])", {"/cameras/0/eye", "an array of 2", "3 numbers"}},
      {R"("eye": [1, 0, 0])", {"/cameras/0/target", "the eye itself"}},
      {R"("target": [0, 5, 0])", {"/cameras/0/up", "not parallel to the viewing direction"}},
      {R"("up": [1, 0, 0])", {"/cameras/0/up"}},
      {R"("up": [0, 0, 0])", {"/cameras/0/up", "no length"}},
      {R"("vertical_fov_degrees": 0)", {"/cameras/0/vertical_fov_degrees"}},
      {R"("near": 0)", {"/cameras/0/near"}},
      {R"("light": "moon")", {"/cameras/0/light", "'moon'", "'sun'"}},
      {R"("name": "\u001b[31m", "light": "\u0000")", {"/cameras/0"}},
  };
  for (const auto& [members, words] : changes) {
    json camera = sound;
    camera.update(json::parse("{" + members + "}"));
    expect_camera_rejected(json::array({camera}), words);
  }
  expect_camera_rejected(json::array({sound, sound}), {"/cameras/1/name", "duplicate name 'a'"});
}

TEST_F(BadSceneFileTest, Lights) {
  const std::string sun = R"("kind": "directional", "direction": [0, -1, 0], "illuminance_lux": )";
  std::string many = sun + "1";
  for (int i = 0; i < 64; ++i) many += "}, {" + sun + "1";
  expect_rows(
      R"("lights": [{)", "}]",
      {
          {R"("kind": "sun")", {"/lights/0/kind", "directional, spot, point"}},
          {R"("kind": "directional", "direction": [0, 0, 1])",
           {"/lights/0/illuminance_lux", "needs it"}},
          {R"("kind": "directional", "direction": [0, 0, 0], "illuminance_lux": 1)",
           {"/lights/0/direction", "no length"}},
          {R"("kind": "point", "position": [0, 0, 0], "intensity_candela": 1, "direction": [0, 0, 1])",
           {"/lights/0/direction", "point light"}},
          {R"("kind": "spot", "position": [0, 0, 0], "direction": [0, 0, 1], "intensity_candela": 1,
          "inner_cone_degrees": 50, "outer_cone_degrees": 40)",
           {"/lights/0", "inner at most outer"}},
          {sun + "1e30", {"/lights/0/illuminance_lux"}},
          {sun + "\"bright\"", {"/lights/0/illuminance_lux", "\"bright\""}},
          {many, {"/lights", "an array of 65"}},
      });
}

TEST_F(BadSceneFileTest, KeysOfCameras) {
  const std::string still = R"("eye": [0, 0, 0], "target": [0, 0, 1], )",
                    ahead = R"("target": [0, 0, 1], "keys": [)", time = "/cameras/0/keys/0/time",
                    range = "a number from 0 to 1000000";
  expect_rows(R"("cameras": [{"name": "walk", )", "}]",
              {
                  {ahead + R"({"time": 2, "eye": [0, 0, 0]}, {"time": 2, "eye": [1, 0, 0]}])",
                   {"/cameras/0/keys/1/time", "found 2 s", "more than the 2 s"}},
                  {ahead + R"({"time": -1, "eye": [0, 0, 0]}])", {time, range}},
                  {ahead + R"({"eye": [0, 0, 0]}])", {time, "found nothing"}},
                  {still + R"("keys": [{"time": 0}])",
                   {"/cameras/0/keys/0", "only a time", "vertical_fov_degrees"}},
                  {still + R"("keys": [{"time": 0, "eye": [0, 0, 0]}])",
                   {"/cameras/0/keys/0/eye", "a duplicate of /cameras/0/eye"}},
                  {still + R"("keys": [])", {"/cameras/0/keys", "an array of 1 to 65536"}},
                  {still + R"("interpolation": "step")", {"/cameras/0/interpolation", "no keys"}},
                  {R"("keys": [{"time": 0, "eye": [0, 0, 0]}])",
                   {"/cameras/0/target", "found nothing", "or in keys"}},
              });
}

TEST_F(BadSceneFileTest, KeysOfLights) {
  const std::string sun = R"("kind": "directional", "illuminance_lux": 1, )",
                    direction = "/lights/0/keys/0/direction";
  expect_rows(
      R"("lights": [{)", "}]",
      {
          {sun + R"("direction": [0, -1, 0], "keys": [{"time": 0, "eye": [0, 0, 0]}])",
           {"/lights/0/keys/0/eye", "unknown key"}},
          {sun + R"("interpolation": "smooth", "keys": [{"time": 0, "direction": [0, -1, 0]}])",
           {"/lights/0/interpolation", "linear, step"}},
          {sun +
               R"("keys": [{"time": 0, "direction": [0, -2, 0]}, {"time": 1, "direction": [0, 1, 0]}])",
           {"/lights/0/keys/1/direction", "the opposite of the key before"}},
          {sun + R"("keys": [{"time": 0, "direction": [0, 0, 0]}])", {direction, "no length"}},
          {R"("kind": "point", "position": [0, 0, 0], "intensity_candela": 1,
          "keys": [{"time": 0, "direction": [0, -1, 0]}])",
           {"/lights/0/direction", "a point light does not have"}},
      });
}

// Cameras and suns by numbers on the command line.

using ::testing::Not;

const std::string kFront = " --eye 0.278,0.273,-0.18 --target 0.278,0.273,0.28 --fov 75";
const std::string kSmall = test::kSweepOfOne + "--width 32 --height 18 --rsm-size 32";

struct CameraByNumbers : ::testing::Test {
  TemporaryFolder folder;
  Outcome run(const std::string& words) { return run_here(words, folder.path()); }
  Image image(const std::string& words) {
    const Outcome outcome = run(words + " -o image.exr");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return read_image(folder / "image.exr");
  }
};

TEST_F(CameraByNumbers, RendersAndTraces) {
  const Image named = image("render " + kCornell + " --camera front" + kSmall);
  const Image given = image("render " + kCornell + kFront + kSmall);
  EXPECT_LT(compare(named, "named", given, "given").max_error, 1e-4);
  EXPECT_THAT(given.metadata.at("camera"),
              HasSubstr("eye 0.278,0.273,-0.18 target 0.278,0.273,0.28"));
  const Image traced =
      image("pathtrace " + kCornell + kFront + " --spp 1 --width 32 --height 18 --view depth");
  EXPECT_NEAR(
      traced.pixels[4 * (9 * 32 + 3)],
      image("render " + kCornell + kFront + kSmall + " --view depth").pixels[4 * (9 * 32 + 3)],
      1e-4);
}

TEST_F(CameraByNumbers, FileNamesInAnotherEncodingAreWrittenInUtf8) {
  const std::string name = "caf\xe9.gltf";  // Latin-1
  GltfBuilder model;
  model.triangle();
  model.write(folder, name);
  EXPECT_EQ(image("render " + name + kSmall + " --stats stats.json").metadata.at("scene"),
            "caf?.gltf");
  EXPECT_EQ(json::parse(read_file(folder / "stats.json"))["options"]["scene"], "caf?.gltf");
}

// The loader adds a camera and a sun to a bare model, and says so unless the command line replaces
// them.
TEST_F(CameraByNumbers, NotesNameOnlyWhatIsShown) {
  GltfBuilder bare;
  bare.triangle();
  const std::string model = bare.write(folder, "bare.gltf").string();
  const auto notes = [&](const std::string& more) {
    return run("pathtrace " + model + " --spp 1 --width 4 --height 4 -o a.exr" + more).err;
  };
  const std::string eye = " --eye 0,0,3 --target 0,0,0", sun = " --sun 0,-1,-1";
  EXPECT_THAT(notes(""), AllOf(HasSubstr("added one outside"), HasSubstr("added a sun")));
  EXPECT_THAT(notes(eye), AllOf(Not(HasSubstr("added one outside")), HasSubstr("added a sun")));
  EXPECT_THAT(notes(eye + sun), Not(HasSubstr("added")));
}

TEST_F(CameraByNumbers, TheSunReplacesAllLights) {
  const std::string outside = " --eye 0.278,0.273,-0.8 --target 0.278,0.273,0.28" + kSmall;
  const Image dim = image("render " + kCornell + outside + " --sun 0,0,1,2 --view direct"),
              bright = image("render " + kCornell + outside + " --sun 0,0,1,8 --view direct");
  EXPECT_GT(mean(dim.pixels, 0), 0);
  EXPECT_NEAR(mean(bright.pixels, 0) / mean(dim.pixels, 0), 4, 1e-3);
  EXPECT_EQ(bright.metadata.at("sun"), "0,0,1,8");
}

}  // namespace
}  // namespace clpv::test::bad_input_test
