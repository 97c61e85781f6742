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
  const auto pixels = [&](const std::string& words) { return image(words).pixels; };
  const std::vector<float> one = pixels("render " + kCornell + kSmall + " --view direct"),
                           half = pixels("render " + kCornell + kSmall +
                                         " --view direct --light-scale 0.5"),
                           traced = pixels("pathtrace " + kCornell + " --light-scale 0.5 --spp 1" +
                                           " --width 32 --height 18 --view direct");
  double largest = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (i % 4 == 3) continue;  // alpha
    EXPECT_EQ(half[i], 0.5f * one[i]);
    largest = std::max<double>(largest, one[i]);
  }
  EXPECT_GT(largest, 0);
  EXPECT_NEAR(traced[4 * (9 * 32 + 3)], half[4 * (9 * 32 + 3)], 1e-3 * largest);
  EXPECT_EQ(image("render " + kCornell + kSmall + " --light-scale 0.5").metadata.at("light_scale"),
            "0.5");
}

TEST_F(CameraByNumbers, LightScalesWithoutEffectOrMeaningAreRejected) {
  GltfBuilder model;
  model.triangle();
  model.write(folder);
  const auto rejected = [&](const std::string& words) {
    const Outcome outcome = run("render " + words + kSmall + " -o image.exr");
    EXPECT_EQ(outcome.exit_code, 2) << words;
    return outcome.err;
  };
  EXPECT_THAT(rejected("model.gltf --light-scale 2"), HasSubstr("has no lights"));
  EXPECT_THAT(rejected(kCornell + " --light-scale 2 --sun 0,-1,0"), HasSubstr("--sun"));
  for (const char* bad : {"0", "-1", "nan", "inf", "1e7", "two"})
    EXPECT_THAT(rejected(kCornell + " --light-scale " + bad),
                AllOf(HasSubstr("--light-scale"), HasSubstr("1e-06..1000000"), HasSubstr(bad)));
}

TEST_F(CameraByNumbers, FileNamesInAnotherEncodingAreWrittenInUtf8) {
  const std::string name = "caf\xe9.gltf";  // Latin-1
  GltfBuilder model;
  model.triangle();
  model.write(folder, name);
  EXPECT_EQ(image("render " + name + kSmall + " --stats stats.json").metadata.at("scene"),
            "caf?.gltf");
  EXPECT_EQ(json::parse(read_file(folder / "stats.json"))["options"]["scene"], "caf?.gltf");
  EXPECT_EQ(image("pathtrace " + name + " --spp 1 --width 32 --height 18 --stats stats.json")
                .metadata.at("scene"),
            "caf?.gltf");
  const Outcome quality =
      run("quality " + name +
          " --basis sh2 --width 16 --height 9 --noise 0.5 --cache cache --format json" +
          test::kSmallSweep);
  EXPECT_EQ(quality.exit_code, 0) << quality.err;
}

TEST_F(CameraByNumbers, WorksInEveryCommandWithACamera) {
  folder.write("p.csv", "0.28,0.27,0.3,0,-1,0\n");
  for (const std::string& command : std::vector<std::string>{
           "query " + kCornell + " --points p.csv" + kFront + kSmall,
           "sequence " + kCornell + " -o frames --frames 1 --fps 1" + kFront + kSmall,
           "quality " + kCornell + " --basis sh2 --width 16 --height 9 --noise 0.5 --cache cache" +
               test::kSmallSweep + kFront}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 0) << command << outcome.err;
  }
  EXPECT_THAT(run("bench frame --help").out, HasSubstr("--eye"));
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

TEST_F(CameraByNumbers, BadNumbersAreRejected) {
  const std::string render = "render " + kCornell + " -o image.exr";
  const std::vector<std::pair<std::string, std::string>> bad = {
      {" --eye 1,2,3", "--target"},
      {" --target 1,2,3", "--eye"},
      {" --fov 40", "--eye"},
      {" --eye 1,2,3 --target 1,2,3", "the eye itself"},
      {" --eye 1,2,nan --target 1,2,3", "--eye"},
      {" --eye 1,2 --target 1,2,3", "--eye"},
      {" --eye 1e9,2,0 --target 1,2,3", "eye"},
      {" --eye 0,0,0 --target 0,1,0", "parallel"},
      {kFront + " --camera front", "--camera"},
      {" --eye 0,0,0 --target 1,0,0 --fov 0", "--fov"},
      {" --eye 0,0,0 --target 1,0,0 --fov 180", "--fov"},
      {" --eye 0,0,0 --target 1,0,0 --fov nan", "--fov"},
      {" --eye 0,0,0 --target 1,0,0 --near-plane 0", "--near-plane"},
      {" --sun 0,0,0", "--sun"},
      {" --sun 0,1", "--sun"},
      {" --sun 0,1,0,-1", "--sun"},
      {" --sun 0,1,0,10,3", "--sun"},
      {" --sun 0,1,nan", "--sun"},
      {" --medium ''", "--medium"},
      {" --medium -1", "--medium"},
      {" --medium 1,nan", "--medium"},
      {" --medium 1,1e7", "--medium"},
      {" --medium 1,0,1", "--medium"},
      {" --medium 1,0,0,0", "--medium"},
  };
  for (const auto& [words, mentioned] : bad) {
    const Outcome outcome = run(render + words);
    EXPECT_EQ(outcome.exit_code, 2) << words << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(mentioned)) << words;
  }
}

}  // namespace
}  // namespace clpv::test::view_values_test
