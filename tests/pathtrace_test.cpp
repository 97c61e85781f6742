// SPDX-License-Identifier: MIT
// clpv pathtrace: what it writes, what it rejects, and that a rejection costs no time and leaves nothing behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/image_io.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::pathtrace_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

nlohmann::json floor_scene() {
  return {{"model", "model.gltf"},
          {"cameras",
           {{{"name", "down"}, {"eye", {0, 1, 0}}, {"target", {0.01, 0, 0}}, {"vertical_fov_degrees", 90}}}},
          {"lights",
           {{{"name", "sun"}, {"kind", "directional"}, {"direction", {0, -1, 0}}, {"illuminance_lux", 2}}}}};
}

class PathtraceCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    test::GltfBuilder floor;
    floor.square(2);
    floor.write(folder_);
    folder_.write("empty.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}], "scene": 0})");
    folder_.write("floor.json", floor_scene().dump());
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  test::Outcome reference(const std::string& scene, const std::string& arguments) const {
    return test::run_here("pathtrace " + file(scene) + " " + arguments);
  }

  test::TemporaryFolder folder_;
};

TEST_F(PathtraceCommand, WritesLayersMetadataAndStats) {
  const test::Outcome outcome =
      reference("floor.json", "--camera down --width 9 --height 5 --spp 4 --seed 7 --view full,depth -o " +
                                  file("a.exr") + " --stats " + file("a.json"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "") << "stdout is for data";
  const Image image = read_image(file("a.exr"));
  const Image full = extract_layer(image, "full", "a.exr"), depth = extract_layer(image, "depth", "a.exr");
  const float albedo = 1;
  EXPECT_NEAR(full.at(4, 2, 0), albedo * 2 / 3.14159265f, 1e-5);
  EXPECT_NEAR(depth.at(4, 2, 0), 1, 1e-4);
  EXPECT_EQ(full.at(4, 2, 3), 1);
  EXPECT_EQ(image.metadata.at("seed"), "7");
  EXPECT_EQ(image.metadata.at("spp"), "4");
  EXPECT_EQ(image.metadata.at("camera"), "down");
  EXPECT_EQ(image.metadata.at("bounces"), "1");
  const nlohmann::json stats = nlohmann::json::parse(std::ifstream(file("a.json")));
  EXPECT_EQ(stats["schema"], 1);
  EXPECT_EQ(stats["spp"], 4);
  EXPECT_EQ(stats["noise"], 0) << "a lone floor sees no light";
  EXPECT_GT(stats["rays"], 45);
}

TEST_F(PathtraceCommand, BackgroundHasNoAlpha) {
  nlohmann::json scene = floor_scene();
  scene["cameras"][0]["target"] = {0.01, 2, 0};
  folder_.write("up.json", scene.dump());
  const test::Outcome outcome = reference("up.json", "--width 4 --height 4 --spp 2 -o " + file("a.exr"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const float value : read_image(file("a.exr")).pixels) EXPECT_EQ(value, 0);
}

TEST_F(PathtraceCommand, RejectsWithItsOwnExitCode) {
  EXPECT_EQ(reference("floor.json", "-o " + file("nowhere/a.exr")).exit_code, 1);
  EXPECT_EQ(reference("floor.json", "-o " + file("a.exr") + " --stats " + file("nowhere/a.json")).exit_code,
            1);
  EXPECT_EQ(reference("absent.json", "-o " + file("a.exr")).exit_code, 3);
  EXPECT_FALSE(fs::exists(file("a.exr")));
}

TEST_F(PathtraceCommand, RejectsASceneWithoutLightOrSurface) {
  nlohmann::json scene = floor_scene();
  scene["lights"] = nlohmann::json::array();
  folder_.write("dark.json", scene.dump());
  const test::Outcome dark = reference("dark.json", "-o " + file("a.exr"));
  EXPECT_EQ(dark.exit_code, 3);
  EXPECT_THAT(dark.err, HasSubstr("light"));
  scene = floor_scene();
  scene["model"] = "empty.gltf";
  folder_.write("empty.json", scene.dump());
  const test::Outcome empty = reference("empty.json", "-o " + file("a.exr"));
  EXPECT_EQ(empty.exit_code, 3);
  EXPECT_THAT(empty.err, HasSubstr("surface"));
  EXPECT_FALSE(fs::exists(file("a.exr")));
}

}  // namespace
}  // namespace clpv::pathtrace_test
