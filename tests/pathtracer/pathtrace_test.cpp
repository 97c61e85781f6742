// SPDX-License-Identifier: MIT
// Ground truth: the files of `clpv pathtrace`; and cached images of `clpv quality`, which are
// traced again only when an input changes or their file is damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/image_io.hpp"
#include "quality/ground_truth.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace clpv::pathtrace_test {
namespace {

namespace fs = std::filesystem;

nlohmann::json floor_scene() {
  return {{"model", "model.gltf"},
          {"cameras",
           {{{"name", "down"},
             {"eye", {0, 1, 0}},
             {"target", {0.01, 0, 0}},
             {"vertical_fov_degrees", 90}}}},
          {"lights",
           {{{"name", "sun"},
             {"kind", "directional"},
             {"direction", {0, -1, 0}},
             {"illuminance_lux", 2}}}}};
}

class PathtraceCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    test::GltfBuilder floor;
    floor.square(2);
    floor.write(folder_);
    folder_.write("floor.json", floor_scene().dump());
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  test::Outcome reference(const std::string& scene, const std::string& arguments) const {
    return test::run_here("pathtrace " + file(scene) + " " + arguments);
  }

  test::TemporaryFolder folder_;
};

TEST_F(PathtraceCommand, WritesLayersMetadataAndStats) {
  const test::Outcome outcome = reference(
      "floor.json", "--camera down --width 9 --height 5 --spp 4 --seed 7 --view full,depth -o " +
                        file("a.exr") + " --stats " + file("a.json"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "") << "stdout is for data";
  const Image image = read_image(file("a.exr"));
  const Image full = extract_layer(image, "full", "a.exr"),
              depth = extract_layer(image, "depth", "a.exr");
  const float albedo = 1;
  EXPECT_NEAR(full.at(4, 2, 0), albedo * 2 / 3.14159265f, 1e-5);
  EXPECT_NEAR(depth.at(4, 2, 0), 1, 1e-4);
  EXPECT_EQ(full.at(4, 2, 3), 1);
  EXPECT_EQ(image.metadata.at("seed"), "7");
  EXPECT_EQ(image.metadata.at("spp"), "4");
  EXPECT_EQ(image.metadata.at("camera"), "down");
  EXPECT_EQ(image.metadata.at("bounces"), "all");
  const nlohmann::json stats = nlohmann::json::parse(std::ifstream(file("a.json")));
  EXPECT_EQ(stats["schema"], 1);
  EXPECT_EQ(stats["spp"], 4);
  EXPECT_EQ(stats["noise"], 0) << "a lone floor sees no light";
  EXPECT_GT(stats["rays"], 45);
}

TEST_F(PathtraceCommand, ViewsWithoutRandomPathsTakeOne) {
  const test::Outcome outcome = reference(
      "floor.json",
      "--width 9 --height 5 --noise 0.001 --view albedo,normal,depth,direct -o " + file("a.exr"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_image(file("a.exr")).metadata.at("spp_traced"), "1");
}

using pathtracer::PathTracerOptions;

class CachedReference : public ::testing::Test {
 protected:
  void SetUp() override {
    const unsigned white = test::add_material(scene_, glm::vec3(0.8f));
    test::add_quad(scene_, {-2, -1, -4}, {4, 0, 0}, {0, 2, 0}, white);
    test::add_quad(scene_, {-2, -1, 0}, {4, 0, 0}, {0, 0, -4}, white);
    scene_.name = "room/1";
    scene_.path = "room";
    scene_.lights = {{"sun", test::directional_light({0.2f, -1, -0.5f})}};
    camera_.name = "front";
    options_.samples = 4;
  }

  GroundTruth get(int width = 12) const {
    return cached_ground_truth(folder_, scene_, camera_, width, 8, options_);
  }

  test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_ / "references";
  SceneData scene_;
  SceneCamera camera_;
  PathTracerOptions options_;
};

TEST_F(CachedReference, KeyDependsOnEveryInput) {
  get();
  EXPECT_TRUE(get(13).traced);
  camera_.eye.x += 0.01f;
  EXPECT_TRUE(get().traced);
  options_.seed = 2;
  EXPECT_TRUE(get().traced);
  options_.samples = 5;
  EXPECT_TRUE(get().traced);
  options_.bounces = PathTracerOptions::kAllBounces;
  EXPECT_TRUE(get().traced);
  scene_.lights[0].data.intensity[1] = 2;
  EXPECT_TRUE(get().traced);
  scene_.materials[0].base_colour[0] = 0.5f;
  EXPECT_TRUE(get().traced);
  scene_.vertices[3].position[2] -= 0.5f;
  EXPECT_TRUE(get().traced);
  options_.threads = 1;
  scene_.path = "elsewhere";
  EXPECT_FALSE(get().traced) << "neither of these changes the image";
}

}  // namespace
}  // namespace clpv::pathtrace_test
