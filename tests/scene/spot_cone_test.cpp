// SPDX-License-Identifier: MIT
// Cones of spot lights: of a degree and less, up to 90 degrees, with a hard edge, and without
// values in the model. A lamp of 8 pi cd, 2 m above a floor of albedo 0.5, whose radiance below it
// is 1.
#include <glm/gtc/constants.hpp>

#include "image/image_io.hpp"
#include "reference/lighting.hpp"
#include "scene/scene.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::spot_cone_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kIntensity = 8 * glm::pi<double>(), kHeight = 2;

/// A model of the floor and the lamp, whose `spot` is that.
GltfBuilder floor_and_lamp(const json& spot) {
  GltfBuilder model;
  model.square(4);
  model.document["meshes"][0]["primitives"][0]["material"] = 0;
  model.document["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}}};
  json light = {{"name", "lamp"}, {"type", "spot"}, {"intensity", kIntensity}};
  if (!spot.is_null()) light["spot"] = spot;
  model.document["extensions"]["KHR_lights_punctual"]["lights"] = {light};
  model.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
                      {"translation", {0, kHeight, 0}},
                      {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}});
  return model;
}

json cone(double inner, double outer) {
  return {{"innerConeAngle", inner}, {"outerConeAngle", outer}};
}

/// Irradiance at an angle from the axis, relative to the lamp without a cone.
double relative_at(const ClpvLight& light, double angle) {
  const glm::dvec3 at(std::sin(angle), kHeight - std::cos(angle), 0);  // at 1 m
  return reference::light_at(light, at).irradiance.x / kIntensity;
}

struct SpotCone : GltfTest {
  ClpvLight lamp(const json& spot) {
    model = floor_and_lamp(spot);
    loaded = load();
    return loaded.lights.at(0).data;
  }
  SceneData loaded;
};

TEST_F(SpotCone, FullIntensityInsideNoneOutsideWhateverTheAngles) {
  const double right = glm::half_pi<double>();
  const std::vector<std::pair<double, double>> cones = {{0, 0.5},
                                                        {0.3, 0.30000001},
                                                        {0.3, 0.3},
                                                        {0.08968102931976317, 0.08968102931976318},
                                                        {0, right},
                                                        {0, 1.57079637},
                                                        {1.57079637, 1.57079637},
                                                        {1.5, 1.5707963705062866},
                                                        {0, 1e-3},
                                                        {0, 1e-6},
                                                        {0, 1e-9},
                                                        {0.9 * right / 90, right / 90},
                                                        {1e-6, 2e-6}};
  for (const auto& [inner, outer] : cones) {
    const ClpvLight light = lamp(cone(inner, outer));
    EXPECT_NEAR(relative_at(light, 0), 1, 1e-6) << outer;
    EXPECT_NEAR(relative_at(light, 0.99 * inner), 1, 1e-4) << inner << ' ' << outer;
    EXPECT_NEAR(relative_at(light, std::min(1.01 * outer, right + 1e-6)), 0, 1e-4)
        << inner << ' ' << outer;
    const Cone stored = cone_of(light);
    EXPECT_NEAR(stored.outer / std::min(outer, right), 1, 1e-4);
    EXPECT_NEAR(stored.inner, std::min(inner, right), 1e-3 * outer);
    EXPECT_EQ(loaded.notes.size(), inner < std::min(outer, right) ? 1u : 2u) << "no camera";
  }
}

TEST_F(SpotCone, TheRampIsGltfsOneAtEachWidth) {
  for (const double outer : {0.5, 0.02, 1e-3, 1e-5}) {
    const double inner = 0.5 * outer;
    const ClpvLight light = lamp(cone(inner, outer));
    EXPECT_EQ(light.narrow_cone, outer < 0.1 ? 1u : 0u);
    for (const double part : {0.6, 0.75, 0.9}) {
      const auto below_one = [](double angle) { return 2 * std::pow(std::sin(angle / 2), 2); };
      const double ramp =
          (below_one(outer) - below_one(part * outer)) / (below_one(outer) - below_one(inner));
      EXPECT_NEAR(relative_at(light, part * outer), ramp * ramp, 2e-3) << outer << ' ' << part;
    }
  }
}

TEST_F(SpotCone, EqualAnglesAreAHardEdgeWithANote) {
  lamp(cone(0.3, 0.3));
  EXPECT_THAT(loaded.notes, Contains(AllOf(HasSubstr("/lights/0/spot"), HasSubstr("both 0.3"),
                                           HasSubstr("hard edge"))));
}

TEST_F(SpotCone, DefaultsAreZeroAndFortyFiveDegrees) {
  for (const json& spot : {json(), json::object(), cone(0, glm::quarter_pi<double>())}) {
    const Cone stored = cone_of(lamp(spot));
    EXPECT_NEAR(stored.inner, 0, 1e-3);
    EXPECT_NEAR(stored.outer, glm::quarter_pi<double>(), 1e-6);
  }
}

TEST_F(SpotCone, ConesThatTheFormatExcludesAreRejected) {
  const auto rejected = [&](const json& spot) {
    model = floor_and_lamp(spot);
    return rejection(model.write(folder));
  };
  EXPECT_THAT(rejected(cone(0.5, 0.4)), HasSubstr("inner less than outer"));
  EXPECT_THAT(rejected(cone(0.5, 0.5 - 1e-12)), HasSubstr("inner less than outer"));
  EXPECT_THAT(rejected(cone(0, 1.5708)), HasSubstr("outerConeAngle: found 1.5708"));
  EXPECT_THAT(rejected(cone(1.5708, 1.5708)), HasSubstr("innerConeAngle: found 1.5708"));
  EXPECT_THAT(rejected(cone(0, 0)), HasSubstr("outerConeAngle: found 0"));
  EXPECT_THAT(rejected("wide"), HasSubstr("lights/0/spot: found \"wide\""));
}

TEST_F(SpotCone, BothRenderersShowAConeOfADegree) {
  floor_and_lamp(json()).write(folder);
  for (const char* angles : {R"("inner_cone_degrees": 0.9, "outer_cone_degrees": 1)",
                             R"("inner_cone_degrees": 1, "outer_cone_degrees": 1)"}) {
    folder.write("narrow.json", fmt::format(R"({{"model": "model.gltf",
      "cameras": [{{"name": "above", "eye": [0, 1.5, 0], "target": [0, 0, 0], "up": [0, 0, -1],
                    "vertical_fov_degrees": 4}}],
      "lights": [{{"kind": "spot", "position": [0, 2, 0], "direction": [0, -1, 0],
                   "intensity_candela": {}, {}}}]}})",
                                            kIntensity, angles));
    for (const std::string& command :
         {"render" + test::kSweepOfOne + "--rsm-size 32", std::string("pathtrace")}) {
      const Outcome outcome =
          must_run_here(command + " narrow.json --view direct --width 33 --height 33 -o image.exr",
                        folder.path());
      const Image image = read_image(folder / "image.exr");
      // 4 degrees from 1.5 m show 0.105 m; the cone has a radius of 0.035 m.
      EXPECT_NEAR(image.pixels[image.channels.size() * (16 * 33 + 16)], 1, 2e-3) << command;
      EXPECT_NEAR(image.pixels[image.channels.size() * (16 * 33 + 24)], 1, 4e-3) << command;
      EXPECT_EQ(image.pixels[image.channels.size() * (16 * 33 + 29)], 0) << command;
    }
  }
}

}  // namespace
}  // namespace clpv::test::spot_cone_test
