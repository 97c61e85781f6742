// SPDX-License-Identifier: MIT
// Path-traced light at points: closed forms, and the pixels of an image.

#include "pathtracer/point_tracer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "basis/bases.hpp"
#include "clpv/pathtrace.hpp"
#include "image/image_io.hpp"
#include "pipeline/raster/view.hpp"
#include "quality/ground_truth.hpp"
#include "reference/view.hpp"
#include "scene/load.hpp"
#include "scene/sky.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::point_tracer_test {

using namespace test;
using pathtracer::PointLight;
using pathtracer::PointTracer;
using std::numbers::pi;
using ::testing::HasSubstr;

PathTracerOptions paths(std::uint32_t samples, int bounces = 1) {
  PathTracerOptions options;
  options.samples = samples, options.bounces = bounces;
  return options;
}

PointLight light_at(const SceneData& scene, const SurfacePoint& point,
                    const PathTracerOptions& options) {
  return PointTracer(scene, scene.lights, options).irradiance(std::span(&point, 1)).points[0];
}

/// Harmonics of bands 0 to 2.
pathtracer::Moments nine() {
  static const SphericalHarmonics kBasis(3);
  return {9, [](const glm::dvec3& w, std::span<double> g) { kBasis.evaluate(w, g); }};
}

// Radiance E / (1 - a) from everywhere.
TEST(PointTracer, FurnaceHasOneRadiance) {
  const SceneData scene = furnace(0.5f, 2);
  const double radiance = 4;
  const PathTracerOptions all = paths(4096, PathTracerOptions::kAllBounces);
  for (const SurfacePoint& point :
       {SurfacePoint{{0.3, 0.4, 0.6}, glm::normalize(glm::dvec3(1, 2, -1))},
        {{0.3, 0, 0.6}, {0, 1, 0}}}) {
    const PointLight light = light_at(scene, point, all);
    EXPECT_EQ(light.direct, glm::dvec3(0));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(light.indirect[c], pi * radiance, 0.01 * pi * radiance);
      EXPECT_GT(light.error[c], 0);
      EXPECT_LT(light.error[c], 0.01 * pi * radiance);
    }
  }
  const glm::dvec3 middle(0.5);
  PointTracer tracer(scene, {}, all);
  const pathtracer::TracedProbes probe = tracer.probes(std::span(&middle, 1), nine());
  EXPECT_NEAR(probe.indirect[0].x, std::sqrt(4 * pi) * radiance, 0.01 * 3.5449 * radiance);
  for (std::size_t i = 1; i < 9; ++i) EXPECT_NEAR(probe.indirect[i].x, 0, 0.02 * 3.5449 * radiance);
}

// A sun straight down on a large grey floor: a E from all directions below.
TEST(PointTracer, SunlitPatch) {
  SceneData scene = floor_scene(0.5f);
  scene.lights = {sun({0, -1, 0}, 2)};
  const PointLight down = light_at(scene, {{0, 0.01, 0}, {0, -1, 0}}, paths(64));
  EXPECT_EQ(down.direct, glm::dvec3(0));
  EXPECT_NEAR(down.indirect.x, 0.5 * 2, 1e-4);
  const PointLight up =
      light_at(scene, {{0, 0, 0}, glm::normalize(glm::dvec3(0, 1, 1))}, paths(64));
  EXPECT_NEAR(up.direct.x, 2 * std::sqrt(0.5), 1e-5);
  EXPECT_EQ(up.indirect, glm::dvec3(0)) << "a lone floor sees no light";
  const glm::dvec3 position(0, 0.01, 0);
  PointTracer tracer(scene, scene.lights, paths(1024));
  const auto direct = tracer.direct(std::span(&position, 1), nine());
  EXPECT_NEAR(direct[0].x, 2 * std::sqrt(1 / (4 * pi)), 1e-6);
  EXPECT_NEAR(direct[1].x, 2 * std::sqrt(3 / (4 * pi)), 1e-6) << "y";
  const auto probe = tracer.probes(std::span(&position, 1), nine());
  const double below = 0.5 * 2 / pi;  // radiance of a half-space
  EXPECT_NEAR(probe.indirect[0].x, below * std::sqrt(pi), 0.01 * below * std::sqrt(pi));
  EXPECT_NEAR(probe.indirect[1].x, -below * pi * std::sqrt(3 / (4 * pi)), 0.01 * below * pi);
}

// Points at the positions and normals of an image's pixels have the image's light.
TEST(PointTracer, EqualsTheImageAtItsPixels) {
  const SceneData scene = load_scene(kCornell);
  const SceneCamera& camera = scene.camera("");
  const ClpvView view = camera_view(camera, 16, 9);
  const TracedImage image =
      pathtracer::trace_paths(scene, scene.lights_for(camera), view, paths(1024));
  std::vector<SurfacePoint> points;
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (image.depth[i] <= 0) continue;
    pixels.push_back(i);
    points.push_back({reference::surface_position(view, i, double{image.depth[i]}),
                      glm::dvec3(image.normal[i])});
  }
  ASSERT_GT(points.size(), 60u);
  PointTracer tracer(scene, scene.lights_for(camera), paths(1024));
  const pathtracer::TracedPoints traced = tracer.irradiance(points);
  EXPECT_LT(traced.noise, 0.05);
  double squares = 0, all = 0;
  int shadows = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 wanted(image.irradiance[pixels[i]]),
        off = traced.points[i].indirect - wanted,
        direct = traced.points[i].direct - glm::dvec3(image.direct[pixels[i]]);
    squares += glm::dot(off, off), all += glm::dot(wanted, wanted);
    shadows += glm::length(direct) > 1e-4 * (1 + glm::length(traced.points[i].direct));
  }
  EXPECT_LT(std::sqrt(squares / all), 0.05);
  EXPECT_LE(shadows, 1) << "at an edge of a shadow";
}

// Tiles, threads and the number of points do not change a point's paths.
TEST(PointTracer, OneProbeIsTheSameAmongOthers) {
  const SceneData scene = furnace(0.5f, 1);
  const std::vector<glm::dvec3> positions{{0.2, 0.2, 0.2}, {0.7, 0.5, 0.3}, {0.5, 0.9, 0.5}};
  PathTracerOptions options = paths(64);
  options.threads = 2;
  PointTracer tracer(scene, {}, options);
  const auto all = tracer.probes(positions, nine());
  const auto last = tracer.probes(std::span(positions).last(1), nine(), 2);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(all.indirect[18 + i], last.indirect[i]);
  const auto walls = tracer.surroundings(positions);
  EXPECT_EQ(walls[0].backs, 0);
  EXPECT_EQ(walls[0].open, 0);
  const glm::dvec3 outside(3, 0.5, 0.5);
  const auto behind = tracer.surroundings(std::span(&outside, 1))[0];
  EXPECT_NEAR(behind.backs + behind.open, 1, 1e-9);
  EXPECT_GT(behind.backs, 0);
}

TEST(PathtracePoints, OfTheLibraryAreThoseOfTheCommand) {
  const TemporaryFolder folder;
  folder.write("p.csv", "0.28,0.27,0.1,0,0,2\n0.28,0.5,0.3,0,-1,0\n");
  const auto query = [&](const std::string& more) {
    return run_here("query " + kCornell + " --points p.csv " + more, folder.path());
  };
  const Outcome outcome = query("--truth --spp 64 --basis sh3");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr(",error_blue,c0_red,"),
                                          HasSubstr(",c8_blue\n0.28,0.27,0.1,0,0,1,")));
  const std::array<float, 3> positions[] = {{0.28f, 0.27f, 0.1f}, {0.28f, 0.5f, 0.3f}},
                             normals[] = {{0, 0, 2}, {0, -1, 0}};
  TraceOptions options;
  options.samples = 64;
  const Scene scene(kCornell);
  const PointLights lights = pathtrace_points(scene, positions, normals, options);
  ASSERT_EQ(lights.indirect.size(), 2u);
  const double red = std::atof(outcome.out.c_str() + outcome.out.find("0,-1,0,") + 7);
  EXPECT_NEAR(lights.indirect[1][0], red, 1e-3 * red);
  EXPECT_GT(red, 0.01);
  EXPECT_EQ(lights.samples, 64u);
  EXPECT_THAT(error_of(ExitCode::usage, [&] { pathtrace_points(scene, positions, {}); }),
              HasSubstr("2 positions and 0 normals"));
  const auto rejected = [&](const std::array<float, 3>& position, int threads) {
    TraceOptions other = options;
    other.threads = threads;
    return error_of(ExitCode::usage, [&] {
      pathtrace_points(scene, std::span(&position, 1), std::span(normals, 1), other);
    });
  };
  EXPECT_THAT(rejected({0, 1e19f, 0}, 0), HasSubstr("point 0: found position (0, 1e+19, 0)"));
  EXPECT_THAT(rejected({0, 0, 0}, -1), HasSubstr("threads: found -1; allowed: 1 to 1024"));
  EXPECT_THAT(rejected({0, 0, 0}, 1025), HasSubstr("threads: found 1025"));
  const std::vector<std::array<float, 3>> many((1 << 20) + 1);
  EXPECT_THAT(error_of(ExitCode::usage,
                       [&] { pathtrace_points(scene, many, std::span(normals, 1), options); }),
              HasSubstr("found 1048577 points, allowed: at most 1048576"));
  EXPECT_THAT(query("--noise 0.1").err, HasSubstr("--noise has no effect without --truth"));
  EXPECT_THAT(query("--truth --grid 16").err, HasSubstr("--grid has no effect with --truth"));
  EXPECT_EQ(query("--truth --grid 16").exit_code, 2);
}

// Ground truth: the files of `clpv pathtrace`; and cached images of `clpv quality`, which are
// traced again only when an input changes or their file is damaged.

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

struct PathtraceCommand : ::testing::Test {
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

struct CachedReference : ::testing::Test {
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

}  // namespace clpv::point_tracer_test
