// SPDX-License-Identifier: MIT
// Cameras and suns by numbers on the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/image_io.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace clpv::test::view_values_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
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
  double difference = 0;
  for (std::size_t i = 0; i < named.pixels.size(); ++i)
    difference = std::max(difference, std::abs(double{named.pixels[i]} - given.pixels[i]));
  EXPECT_LT(difference, 1e-4);
  EXPECT_THAT(given.metadata.at("camera"),
              HasSubstr("eye 0.278,0.273,-0.18 target 0.278,0.273,0.28"));
  const Image traced =
      image("pathtrace " + kCornell + kFront + " --spp 1 --width 32 --height 18 --view depth");
  EXPECT_NEAR(
      traced.pixels[4 * (9 * 32 + 3)],
      image("render " + kCornell + kFront + kSmall + " --view depth").pixels[4 * (9 * 32 + 3)],
      1e-4);
}

TEST_F(CameraByNumbers, LightScaleMultipliesTheLightsOfTheFile) {
  const std::string direct = kSmall + " --view direct";
  const Image one = image("render " + kCornell + direct),
              half = image("render " + kCornell + direct + " --light-scale 0.5"),
              traced = image("pathtrace " + kCornell + " --light-scale 0.5 --spp 1 --width 32" +
                             " --height 18 --view direct");
  const std::size_t at = 4 * (9 * 32 + 3);
  EXPECT_GT(one.pixels[at], 0);
  EXPECT_EQ(half.pixels[at], 0.5f * one.pixels[at]);
  EXPECT_NEAR(traced.pixels[at], half.pixels[at], 1e-3f * one.pixels[at]);
  EXPECT_EQ(half.metadata.at("light_scale"), "0.5");
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
  EXPECT_THAT(notes(""), AllOf(HasSubstr("added one that frames"), HasSubstr("added a sun")));
  EXPECT_THAT(notes(eye), AllOf(Not(HasSubstr("added one that frames")), HasSubstr("added a sun")));
  EXPECT_THAT(notes(eye + sun), Not(HasSubstr("added")));
}

TEST_F(CameraByNumbers, TheSunReplacesAllLights) {
  const std::string outside = " --eye 0.278,0.273,-0.8 --target 0.278,0.273,0.28" + kSmall;
  const Image dim = image("render " + kCornell + outside + " --sun 0,0,1,2 --view direct"),
              bright = image("render " + kCornell + outside + " --sun 0,0,1,8 --view direct");
  double sums[2] = {};
  for (std::size_t i = 0; i < dim.pixels.size(); i += 4)
    sums[0] += dim.pixels[i], sums[1] += bright.pixels[i];
  EXPECT_GT(sums[0], 0);
  EXPECT_NEAR(sums[1] / sums[0], 4, 1e-3);
  EXPECT_EQ(bright.metadata.at("sun"), "0,0,1,8");
}

}  // namespace
}  // namespace clpv::test::view_values_test
