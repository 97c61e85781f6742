// SPDX-License-Identifier: MIT
// clpv reference: what it writes, what it refuses, and that a refusal leaves nothing behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/image_io.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::reference_test {
namespace {

using test::json;
using ::testing::HasSubstr;

/// A floor of 4 x 4 m at y = 0, facing up, seen from 1 m above it and lit by a sun.
class ReferenceCommand : public ::testing::Test {
 protected:
  ReferenceCommand() {
    test::GltfBuilder floor;
    floor.mesh({{"POSITION", floor.accessor<float>("VEC3", {-2, 0, -2, -2, 0, 2, 2, 0, 2,  //
                                                            -2, 0, -2, 2, 0, 2, 2, 0, -2})}});
    floor.write(folder_, "floor.gltf");
    write_scene();
  }
  void write_scene() const { folder_.write("scene.json", scene_.dump()); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  test::Outcome reference(const std::string& arguments) const {
    return test::run(CLPV_PROGRAM " reference " + file("scene.json") + " --width 9 --height 5 " + arguments);
  }

  test::TemporaryFolder folder_;
  json scene_ = {
      {"model", "floor.gltf"},
      {"metres_per_unit", 1},
      {"cameras",
       {{{"name", "down"}, {"eye", {0, 1, 0}}, {"target", {0.01, 0, 0}}, {"vertical_fov_degrees", 90}}}},
      {"lights",
       {{{"name", "sun"}, {"kind", "directional"}, {"direction", {0, -1, 0}}, {"illuminance_lux", 2}}}}};
};

TEST_F(ReferenceCommand, WritesLayersMetadataAndStats) {
  const test::Outcome outcome = reference("--camera down --spp 4 --seed 7 --view full,depth -o " +
                                          file("a.exr") + " --stats " + file("a.json"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "") << "stdout is for data";
  const Image image = read_image(file("a.exr"));
  const Image full = extract_layer(image, "full", "a.exr"), depth = extract_layer(image, "depth", "a.exr");
  EXPECT_NEAR(full.at(4, 2, 0), 2 / 3.14159265f, 1e-5);
  EXPECT_NEAR(depth.at(4, 2, 0), 1, 1e-4);
  EXPECT_EQ(full.at(4, 2, 3), 1);
  const std::pair<const char*, const char*> metadata[] = {
      {"seed", "7"}, {"spp", "4"}, {"camera", "down"}, {"bounces", "1"}};
  for (const auto& [name, value] : metadata) EXPECT_EQ(image.metadata.at(name), value) << name;
  const json stats = json::parse(test::read_file(file("a.json")));
  EXPECT_EQ(stats["schema"], 1);
  EXPECT_EQ(stats["spp"], 4);
  EXPECT_EQ(stats["noise"], 0) << "a lone floor sees no light";
  EXPECT_GT(stats["rays"], 45);
}

TEST_F(ReferenceCommand, BackgroundHasNoAlpha) {
  scene_["cameras"][0]["target"] = {0.01, 2, 0};
  write_scene();
  const test::Outcome outcome = reference("--spp 2 -o " + file("a.exr"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const float value : read_image(file("a.exr")).pixels) EXPECT_EQ(value, 0);
}

TEST_F(ReferenceCommand, RefusesWithItsOwnExitCode) {
  const std::string out = " -o " + file("a.exr");
  for (const char* options : {"--spp 0", "--noise 0", "--spp 4 --noise 0.1", "--bounces 0", "--bounces some",
                              "--view fog", "--camera none"})
    EXPECT_EQ(reference(options + out).exit_code, 2) << options;
  EXPECT_EQ(reference("-o " + file("a.png")).exit_code, 2);
  EXPECT_EQ(reference("-o " + file("nowhere/a.exr")).exit_code, 1);
  EXPECT_EQ(reference(out + " --stats " + file("nowhere/a.json")).exit_code, 1);
  scene_["lights"] = json::array();
  write_scene();
  const test::Outcome dark = reference(out);
  EXPECT_EQ(dark.exit_code, 3);
  EXPECT_THAT(dark.err, HasSubstr("light"));
  EXPECT_FALSE(std::filesystem::exists(file("a.exr")));
}

}  // namespace
}  // namespace clpv::reference_test
