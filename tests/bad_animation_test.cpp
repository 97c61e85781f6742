// SPDX-License-Identifier: MIT
// Hostile and broken glTF animations, one a test: each is refused before anything of the size it asks for is allocated.
#include "tests/support/animation_fixture.hpp"

namespace clpv::test::bad_animation_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct BadAnimationTest : AnimationTest {};

TEST_F(BadAnimationTest, TimesThatDoNotRiseOrAreNone) {
  const auto with_times = [&](const std::vector<float>& times) {
    model.document.erase("animations");
    animate<float>(0, "translation", times, {0, 0, 0, 1, 1, 1, 2, 2, 2});
    return refused();
  };
  EXPECT_THAT(with_times({0, 2, 1}), AllOf(HasSubstr("/animations/0/samplers/0/input"),
                                           HasSubstr("1 s at 2, after 2 s"), HasSubstr("rise")));
  EXPECT_THAT(with_times({0, 1, 1}), HasSubstr("1 s at 2, after 1 s"));
  EXPECT_THAT(with_times({0, NAN, 1}), AllOf(HasSubstr("nan s at 1"), HasSubstr("finite")));
  EXPECT_THAT(with_times({0, 1, INFINITY}), HasSubstr("inf s at 2"));
  EXPECT_THAT(with_times({-1, 0, 1}), HasSubstr("-1 s at 0"));
}

TEST_F(BadAnimationTest, ValuesThatAreNoNumbersOrNoRotations) {
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 1, NAN, 1});
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/samplers/0/output"),
                               HasSubstr("nan in component 1 of element 1")));
  model.document.erase("animations");
  animate<float>(0, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 0.1f});
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/animations/0/samplers/0/output"), HasSubstr("a quaternion of length 0.1"),
                    HasSubstr("at 1"), HasSubstr("unit quaternions")));
}

TEST_F(BadAnimationTest, SplinesThroughNoRotationAreRefusedWhereTheyAre) {
  // From a turn to its negative, at no speed: half way there is nothing.
  animate<float>(0, "rotation", {0, 1},
                 {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0}, "CUBICSPLINE");
  MovingScene moving = load();
  moving.pose(0.4);
  try {
    moving.pose(0.5);
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("model.gltf: /nodes/0/rotation"), HasSubstr("at 0.5 s")));
  }
}

TEST_F(BadAnimationTest, CountsThatDoNotBelongTogether) {
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 1, 1, 1, 2, 2, 2});
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/samplers/0/output"), HasSubstr("found 3 elements"),
                               HasSubstr("1 for each of the 2 times")));
  sampler()["interpolation"] = "CUBICSPLINE";
  EXPECT_THAT(refused(), HasSubstr("3 for each of the 2 times"));
}

TEST_F(BadAnimationTest, AccessorsOfAnotherKind) {
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 1, 1, 1});
  const json sound = model.document;
  sampler()["input"] = model.accessor<std::uint16_t>("SCALAR", {0, 1});
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/samplers/0/input"), HasSubstr("componentType 5123"),
                               HasSubstr("SCALAR of floats")));
  model.document = sound;
  sampler()["input"] = sampler()["output"];
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/samplers/0/input"), HasSubstr("3 components")));
  model.document = sound;
  model.document["animations"][0]["channels"][0]["target"]["path"] = "rotation";
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/samplers/0/output"), HasSubstr("VEC4")));
  model.document = sound;
  accessor_of("output")["componentType"] = 5125;
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/samplers/0/output"), HasSubstr("5125"),
                               HasSubstr("VEC3 of floats")));
}

TEST_F(BadAnimationTest, AHundredMillionKeyframesOutOfNothing) {
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 1, 1, 1});
  for (const char* which : {"input", "output"}) {  // without a view: as many zeros as it says
    accessor_of(which)["count"] = 100000000;
    accessor_of(which).erase("bufferView");
  }
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/samplers/0"), HasSubstr("400000000 times and values"),
                               HasSubstr("at most 16777216")));
}

TEST_F(BadAnimationTest, IndicesOutOfRange) {
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 1, 1, 1});
  const json sound = model.document;
  const std::string animation = "/animations/0";
  for (const std::string place :
       {"/samplers/0/input", "/samplers/0/output", "/channels/0/sampler", "/channels/0/target/node"}) {
    for (const json& bad : {json(1000), json(-1), json(1.5), json("0")}) {
      model.document = sound;
      model.document[json::json_pointer(animation + place)] = bad;
      EXPECT_THAT(refused(),
                  AllOf(HasSubstr(animation + place + ": found " + bad.dump()), HasSubstr("allowed: ")));
    }
  }
  model.document = sound;
  sampler()["interpolation"] = "CUBIC";
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/samplers/0/interpolation"),
                               HasSubstr("LINEAR, STEP, CUBICSPLINE")));
  model.document = sound;
  model.document["animations"][0]["channels"][0]["target"]["path"] = "colour";
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/animations/0/channels/0/target/path"), HasSubstr("translation, rotation")));
  model.document["animations"] = json::array({json::object()});
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/samplers"), HasSubstr("nothing")));
}

TEST_F(BadAnimationTest, NodesThatHaveAMatrix) {
  model.document["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 1, 1, 1});
  EXPECT_THAT(refused(), AllOf(HasSubstr("/animations/0/channels/0/target/node"),
                               HasSubstr("node 0, which has a matrix")));
}

TEST_F(BadAnimationTest, WaysOutOfTheWorld) {
  animate<float>(0, "translation", {0, 1}, {0, 0, 0, 1e30f, 0, 0});
  MovingScene moving = load();
  EXPECT_THROW(moving.pose(1), Error);
  moving.pose(0);
  EXPECT_THAT(position(moving.scene(), 0, 0), IsNear(glm::vec3(0), 0.0f)) << "and can come back";
}

}  // namespace
}  // namespace clpv::test::bad_animation_test
