// SPDX-License-Identifier: MIT
// Skies: maps, their mean radiance per direction, and the light on surfaces.
#include "scene/sky.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numbers>

#include "basis/sky_light.hpp"
#include "basis/sweep.hpp"
#include "image/image.hpp"
#include "image/image_io.hpp"
#include "pathtracer/emitters.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/lighting.hpp"
#include "scene/load.hpp"
#include "scene/scene.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::test::sky_test {
namespace {

using namespace test;
using std::numbers::pi;
using ::testing::HasSubstr;

Sky map_of(int width, int height, const std::function<float(int x, int y)>& radiance) {
  Sky sky;
  sky.width = width, sky.height = height;
  sky.texels.clear();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      sky.texels.emplace_back(radiance(x, y), 0.5f * radiance(x, y), 0);
  }
  return sky;
}

TEST(Sky, TheCentreOfAMapLooksAlongMinusZ) {
  Sky sky = map_of(8, 4, [](int x, int y) { return static_cast<float>(10 * y + x); });
  const double edge = 1e-3;
  EXPECT_NEAR(glm::length(sky.direction(4, 2) - glm::dvec3(0, 0, -1)), 0, 1e-12);
  EXPECT_NEAR(glm::length(sky.direction(6, 2) - glm::dvec3(1, 0, 0)), 0, 1e-12);
  EXPECT_NEAR(glm::length(sky.direction(1, 0) - glm::dvec3(0, 1, 0)), 0, 1e-12);
  EXPECT_EQ(sky.radiance(glm::normalize(glm::dvec3(edge, edge, -1))).x, 14);
  EXPECT_EQ(sky.radiance(glm::normalize(glm::dvec3(-edge, -edge, -1))).x, 23);
  EXPECT_EQ(sky.radiance(glm::normalize(glm::dvec3(edge, -1, -2 * edge))).x, 30 + 4);
  sky.rotation = pi / 2;  // the former centre is to the right
  EXPECT_EQ(sky.radiance(glm::normalize(glm::dvec3(1, edge, edge))).x, 14);
  for (const auto& [x, y] : {std::pair{0.3, 0.4}, {7.9, 3.7}, {4.1, 1.2}}) {
    const auto at = static_cast<std::size_t>(static_cast<int>(y) * 8 + static_cast<int>(x));
    EXPECT_EQ(sky.texel_at(sky.direction(x, y)), at) << x << ' ' << y;
  }
  EXPECT_EQ(sky.interpolated(sky.direction(2.5, 1.5)).x, 12) << "the middle of a texel";
  EXPECT_NEAR(sky.interpolated(sky.direction(3.0, 2.0)).x, (12 + 13 + 22 + 23) / 4.0, 1e-5);
  EXPECT_NEAR(sky.interpolated(sky.direction(0, 1.5)).x, (10 + 17) / 2.0, 1e-5) << "round the seam";
  double all = 0;
  for (int y = 0; y < 4; ++y) all += 8 * sky.solid_angle(y);
  EXPECT_NEAR(all, 4 * pi, 1e-12);
}

TEST(SkyLight, EachDirectionLiesInItsOwnPart) {
  for (const int parts : {1, 2, 3, 4}) {
    const std::vector<SweepBin> bins = sweep_bins(parts);
    for (int b = 0; b < kSweepBins; ++b) {
      for (int part = 0; part < parts * parts; ++part) {
        const SubBin found = sub_bin_along(
            bins[static_cast<std::size_t>(b)].directions[static_cast<std::size_t>(part)].w, parts);
        EXPECT_EQ(found.bin, b);
        EXPECT_EQ(found.part, part);
      }
    }
  }
}

TEST(SkyLight, MeansKeepTheFluxOfAMap) {
  Sky sky = map_of(37, 19, [](int x, int y) { return static_cast<float>((x * 7 + y * 13) % 11); });
  sky.texels[200] = glm::vec3(5000);  // a small sun
  sky.rotation = 0.3;
  glm::dvec3 wanted(0);
  for (int y = 0; y < sky.height; ++y) {
    for (int x = 0; x < sky.width; ++x)
      wanted +=
          sky.solid_angle(y) * glm::dvec3(sky.texels[static_cast<std::size_t>(y * sky.width + x)]);
  }
  for (const int parts : {1, 2, 3}) {
    const std::vector<glm::dvec3> means = sky_means(sky, parts);
    const std::vector<SweepBin> bins = sweep_bins(parts);
    glm::dvec3 sent(0);
    for (std::size_t i = 0; i < means.size(); ++i) {
      const std::size_t of_bin = static_cast<std::size_t>(parts * parts);
      sent += bins[i / of_bin].directions[i % of_bin].solid_angle * means[i];
    }
    EXPECT_NEAR(sent.x, wanted.x, 1e-9 * wanted.x) << parts;
    EXPECT_NEAR(sent.y, wanted.y, 1e-9 * wanted.y) << parts;
  }
}

/// A black floor under `sky`; the camera sees a patch around the origin from 0.3 m.
SceneData under(const Sky& sky, float half = 10) {
  SceneData scene;
  scene.path = "under the sky";
  add_grey(scene, 0);
  add_quad(scene, {-half, 0, -half}, {0, 0, 2 * half}, {2 * half, 0, 0}, 0);
  scene.sky = std::make_shared<const Sky>(sky);
  scene.cameras.push_back({});
  scene.cameras[0].eye = {0, 0.3f, 0}, scene.cameras[0].forward = {0, -1, 0},
  scene.cameras[0].up = {0, 0, -1};
  scene.cameras[0].vertical_fov = 0.3f;
  scene.lower = {-half, 0, -half}, scene.upper = {half, 2, half};
  return scene;
}

void add_black_wall(SceneData& scene, float x, float height) {  // faces -x
  add_quad(scene, {x, 0, -10}, {0, 0, 20}, {0, height, 0}, 0);
}

RenderOptions small_frame() {
  RenderOptions options;
  options.width = options.height = 16, options.cascades = 2, options.cascade_size = 4;
  options.rsm_size = options.shadow_size = 16;
  return options;
}

double lit(const SceneData& scene, const RenderOptions& options = small_frame()) {
  Frame frame(test_session(), scene, options);
  frame.render(scene.cameras[0]);
  return mean(frame.read(Show::irradiance), 0);
}

double traced(const SceneData& scene, int bounces = 1, std::uint32_t samples = 1024) {
  PathTracerOptions options;
  options.samples = samples, options.bounces = bounces;
  return mean(pathtracer::trace_paths(scene, {}, camera_view(scene.cameras[0], 16, 16), options)
                  .irradiance);
}

TEST(SkyFrame, AnOpenPlaneGetsPiTimesTheRadiance) {
  const SceneData scene = under(constant_sky({2, 1, 1}));
  EXPECT_NEAR(traced(scene), 2 * pi, 1e-3);
  EXPECT_NEAR(lit(scene), 2 * pi, 0.03 * 2 * pi);
}

TEST(SkyFrame, ABrightHalfOfTheSkyLightsHalfAsMuch) {
  const Sky east = map_of(2, 1, [](int x, int) { return x == 1 ? 1.0f : 0.0f; });
  const SceneData scene = under(east);
  EXPECT_NEAR(traced(scene), pi / 2, 2e-3);
  EXPECT_NEAR(lit(scene), pi / 2, 0.03 * pi);
  const Sky below = map_of(1, 2, [](int, int y) { return y == 1 ? 1.0f : 0.0f; });
  EXPECT_EQ(traced(under(below)), 0);
  EXPECT_LT(lit(under(below)), 0.15 * pi) << "what leaks through a floor";
}

// A long wall of height h at a distance d leaves (1 + cos(atan(h / d))) / 2 of an even sky.
TEST(SkyFrame, AWallBlocksItsShareOfTheSky) {
  for (const float distance : {0.5f, 1.5f}) {  // the wall transmits about 1/3 along diagonal links
    SceneData scene = under(constant_sky(glm::vec3(1)));
    add_black_wall(scene, distance, 1.5f);
    const double wanted = pi / 2 * (1 + std::cos(std::atan(1.5 / double{distance})));
    EXPECT_NEAR(traced(scene), wanted, 0.01 * pi) << distance;
    EXPECT_NEAR(lit(scene), wanted, 0.12 * pi) << distance;
  }
}

// A small, very bright texel: direct sampling finds it.
TEST(PathTracer, ASmallSunInAMapLightsByItsSolidAngle) {
  constexpr int kWidth = 512, kHeight = 256, kX = 300, kY = 60;
  const Sky sky =
      map_of(kWidth, kHeight, [](int x, int y) { return x == kX && y == kY ? 1e5f : 0.1f; });
  const double cosine = std::cos(pi * (kY + 0.5) / kHeight);
  const double wanted = 0.1 * pi + 1e5 * sky.solid_angle(kY) * cosine;
  EXPECT_NEAR(traced(under(sky), 1, 256), wanted, 0.003 * wanted);
}

TEST(SkyFrame, IsSeenWhereNoSurfaceIs) {
  const Sky sky = map_of(16, 8, [](int x, int y) { return static_cast<float>(x + y); });
  SceneData scene = under(sky);
  scene.cameras[0].forward = {0, 0, -1}, scene.cameras[0].up = {0, 1, 0},
  scene.cameras[0].vertical_fov = 1;
  Frame frame(test_session(), scene, small_frame());
  frame.render(scene.cameras[0]);
  const std::vector<float> full = frame.read(Show::full), indirect = frame.read(Show::indirect);
  PathTracerOptions options;
  options.samples = 2;
  const TracedImage image =
      pathtracer::trace_paths(scene, {}, camera_view(scene.cameras[0], 16, 16), options);
  const Image truth = pathtracer::traced_view(image, Show::full);
  for (std::size_t i = 0; i < 4 * 16; ++i)
    EXPECT_NEAR(full[i], truth.pixels[i], 1e-4) << i;  // the top row
  EXPECT_EQ(full[3], 1);
  EXPECT_GT(full[0], 0);
  EXPECT_EQ(indirect[0] + indirect[3], 0);
  EXPECT_TRUE(frame.read(Show::full) == full);
}

/// A scene file with that member "sky", and a map of two texels; the second has red `value`.
struct SkyFile : ::testing::Test {
  void write(const std::string& sky, float value,
             const std::vector<std::string>& channels = {"R", "G", "B"}) {
    Image image = make_image(2, 1, channels);
    std::fill(image.pixels.begin(), image.pixels.end(), 0.5f);
    image.pixels[channels.size()] = value;
    write_exr(folder_.path() / "map.exr", image);
    std::ofstream(folder_.path() / "scene.json")
        << R"({"model": ")" << CLPV_SOURCE_DIR << R"(/scenes/cornell.glb", "sky": )" << sky << "}";
  }
  void load(const std::string& sky, float value = 1) {
    write(sky, value);
    scene_ = load_scene(folder_ / "scene.json");
  }
  std::string rejection(const std::string& sky, float value = 1,
                        const std::vector<std::string>& channels = {"R", "G", "B"}) {
    write(sky, value, channels);
    return error_of(ExitCode::bad_input, [&] { load_scene(folder_ / "scene.json"); });
  }
  TemporaryFolder folder_;
  SceneData scene_;
};

TEST_F(SkyFile, IsAConstantOrAMap) {
  load(R"({"radiance": [1, 2, 3]})");
  EXPECT_EQ(scene_.sky->texels[0], glm::vec3(1, 2, 3));
  EXPECT_TRUE(scene_.lights.empty()) << "a sky is light enough";
  load(R"({"radiance": [1, 2, 3], "ground": [0.5, 0, 0]})");
  EXPECT_EQ(scene_.sky->radiance({0, 1, 0}), glm::vec3(1, 2, 3));
  EXPECT_EQ(scene_.sky->radiance(glm::normalize(glm::dvec3(1, -0.01, 1))), glm::vec3(0.5f, 0, 0));
  load(R"({"map": "map.exr", "scale": 4, "rotation_degrees": 90})", 3);
  EXPECT_EQ(scene_.sky->texels[1].x, 12);
  EXPECT_EQ(scene_.sky->texels[0].x, 2);
  EXPECT_NEAR(scene_.sky->rotation, pi / 2, 1e-12);
}

TEST_F(SkyFile, IsFoundFromTheFolderThatItLiesIn) {
  load(R"({"map": "map.exr"})");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  for (const char* name : {"scene.json", "./scene.json"}) EXPECT_NO_THROW(load_scene(name)) << name;
  std::filesystem::current_path(before);
}

TEST_F(SkyFile, RejectsInvalidSkies) {
  const std::pair<std::string, std::string> members[] = {
      {"{}", "/sky: found neither radiance nor map"},
      {R"({"map": "map.exr", "radiance": [1, 1, 1]})", "/sky: found radiance and map"},
      {R"({"radiance": [1, -1, 1]})", "/sky/radiance"},
      {R"({"radiance": [1, 1, 1], "scale": 2})", "/sky/scale"},
      {R"({"map": "map.exr", "ground": [1, 1, 1]})", "/sky/ground"},
      {R"({"map": "../map.exr"})", "contains '..'"},
      {R"({"map": "sub/../map.exr"})", "contains '..'"},
      {R"({"map": ")" + (folder_ / "map.exr").string() + R"("})", "an absolute path"},
      {R"({"map": "none.exr"})", "none.exr"},
      {R"({"map": "scene.json"})", "extension"}};
  for (const auto& [sky, words] : members) EXPECT_THAT(rejection(sky), HasSubstr(words));
  const std::string map = R"({"map": "map.exr", "scale": 2})";
  EXPECT_THAT(rejection(map, -0.5f),
              HasSubstr("pixel 1,0 channel R: found -0.5, times 2; allowed: 0 to"));
  EXPECT_THAT(rejection(map, std::numeric_limits<float>::quiet_NaN()),
              HasSubstr("pixel 1,0 channel R: found nan"));
  EXPECT_THAT(rejection(map, std::numeric_limits<float>::infinity()), HasSubstr("found inf"));
  EXPECT_THAT(rejection(map, 1, {"R", "G"}), HasSubstr("no channel B"));
}

// Cones of spot lights: of a degree and less, up to 90 degrees, with a hard edge, and without
// values in the model. A lamp of 8 pi cd, 2 m above a floor of albedo 0.5, whose radiance below it
// is 1.

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
                                                        {0.08968102931976317, 0.08968102931976318},
                                                        {1.57079637, 1.57079637},
                                                        {1.5, 1.5707963705062866},
                                                        {0, 1e-9},
                                                        {0.9 * right / 90, right / 90}};
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

TEST_F(SpotCone, DefaultsAreZeroAndFortyFiveDegrees) {
  for (const json& spot : {json(), json::object(), cone(0, glm::quarter_pi<double>())}) {
    const Cone stored = cone_of(lamp(spot));
    EXPECT_NEAR(stored.inner, 0, 1e-3);
    EXPECT_NEAR(stored.outer, glm::quarter_pi<double>(), 1e-6);
  }
}

}  // namespace
}  // namespace clpv::test::sky_test
