// SPDX-License-Identifier: MIT
// Media: path tracing, kernels and CPU reference against closed forms.
#include "reference/medium.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "basis/sampling.hpp"
#include "basis/sweep.hpp"
#include "image/compare.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/sweep.hpp"
#include "scene/load.hpp"
#include "scene/scene.hpp"
#include "scene/sky.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::medium_test {
using std::numbers::pi;
using namespace test;

ClpvMedium medium_of(const glm::vec3& scattering, const glm::vec3& absorption, float anisotropy,
                     const glm::vec3& lower, const glm::vec3& upper) {
  ClpvMedium medium{};
  for (int i = 0; i < 3; ++i) {
    medium.lower[i] = lower[i], medium.upper[i] = upper[i];
    medium.scattering[i] = scattering[i], medium.extinction[i] = scattering[i] + absorption[i];
  }
  medium.anisotropy = anisotropy;
  return medium;
}

TracedImage traced(const SceneData& scene, const ClpvView& view, int bounces,
                   std::uint32_t samples) {
  PathTracerOptions options;
  options.bounces = bounces;
  options.samples = samples;
  return pathtracer::trace_paths(scene, scene.lights_for({}), view, options);
}

TEST(Medium, PhaseFunctionIntegratesToOneAndHasTheMeanCosineOfItsAnisotropy) {
  for (const double g : {-0.9, -0.3, 0.0, 0.5, 0.9}) {
    double integral = 0, mean_cosine = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = -1 + 2 * (i + 0.5) / kSteps,
                   weight = 4 * pi / kSteps * phase(g, cosine);
      integral += weight;
      mean_cosine += cosine * weight;
    }
    EXPECT_NEAR(integral, 1, 1e-6);
    EXPECT_NEAR(mean_cosine, g, 1e-6);
  }
}

TEST(Medium, PartOfARayIsThatInTheBox) {
  const ClpvMedium medium = medium_of(glm::vec3(1), {}, 0, {-1, -2, -3}, {1, 2, 3});
  const double far = std::numeric_limits<double>::infinity();
  const auto length = [&](const glm::dvec3& origin, const glm::dvec3& direction, double end) {
    return medium_part(medium, origin, direction, end).length();
  };
  EXPECT_DOUBLE_EQ(length({-5, 0, 0}, {1, 0, 0}, far), 2);
  EXPECT_DOUBLE_EQ(length({-5, 0, 0}, {1, 0, 0}, 5), 1);
  EXPECT_DOUBLE_EQ(length({0, 0, 0}, {0, 0, -1}, far), 3);
  EXPECT_DOUBLE_EQ(length({0, 0, 0}, {0, 0, -1}, 0.5), 0.5);
  EXPECT_DOUBLE_EQ(length({-5, 0, 0}, {-1, 0, 0}, far), 0);
  EXPECT_DOUBLE_EQ(length({-5, 2.5, 0}, {1, 0, 0}, far), 0);
}

TEST(Medium, SceneFilesHaveOneInABoxOrInTheirBounds) {
  const TemporaryFolder folder;
  const auto loaded = [&](const std::string& medium) {
    const std::string model = CLPV_SOURCE_DIR "/scenes/cornell.glb";
    return load_scene(
        folder.write("scene.json", R"({"model": ")" + model + R"(", "medium": )" + medium + "}"));
  };
  const SceneData boxed = loaded(
      R"({"scattering": [1, 2, 3], "absorption": [1, 0, 2], "anisotropy": 0.5,
          "box": {"lower": [0, 0, 0], "upper": [1, 2, 3]}})");
  EXPECT_EQ(vector(boxed.medium->extinction), glm::dvec3(2, 2, 5));
  EXPECT_EQ(vector(boxed.medium->upper), glm::dvec3(1, 2, 3));
  const SceneData bounded = loaded(R"({"scattering": [1, 1, 1]})");
  EXPECT_EQ(vector(bounded.medium->lower), glm::dvec3(bounded.lower));
  EXPECT_EQ(vector(bounded.medium->upper), glm::dvec3(bounded.upper));
  const std::pair<const char*, const char*> bad[] = {
      {"{}", "/medium: found neither scattering nor absorption"},
      {R"({"scattering": [-1, 0, 0]})", "/medium/scattering"},
      {R"({"scattering": [1e7, 0, 0]})", "/medium/scattering"},
      {R"({"scattering": [1, 1]})", "/medium/scattering"},
      {R"({"absorption": [1, 1, 1], "anisotropy": 1})", "/medium/anisotropy"},
      {R"({"absorption": [1, 1, 1], "box": {"lower": [0, 0, 0]}})", "/medium/box/upper"},
      {R"({"absorption": [1, 1, 1], "box": {"lower": [0, 0, 0], "upper": [1, 0, 1]}})",
       "/medium/box: found 0,0,0 to 1,0,1; allowed: an upper corner above the lower one"},
      {R"({"absorption": [1, 1, 1], "colour": [1, 1, 1]})", "colour"}};
  for (const auto& [medium, message] : bad)
    EXPECT_THAT(error_of(ExitCode::bad_input, [&] { loaded(medium); }), testing::HasSubstr(message))
        << medium;
}

/// A room of 2 m, faces inwards, whose walls emit and do not reflect.
SceneData room(float emitted) {
  SceneData scene;
  scene.path = "room";
  add_grey(scene, 0);
  for (float& e : scene.materials[0].emissive) e = emitted;
  add_box(scene, glm::vec3(-1), 2, 0);
  return scene;
}

const ClpvView kInRoom = view_of({0.1, 0.2, 0.3}, {0.3, 0.1, -1}, {0, 1, 0}, 1, 4, 4);

TEST(Medium, AbsorptionFollowsBeersLaw) {
  SceneData scene = room(3);
  const glm::vec3 absorption(0.2, 1, 4);
  scene.medium = medium_of({}, absorption, 0, glm::vec3(-1), {1, 1, 0});
  const ClpvView view = view_of({0, 0, 0.5}, {0, 0, -1}, {0, 1, 0}, 1e-3f, 1, 1);
  const Image seen = pathtracer::traced_view(traced(scene, view, 1, 16), Show::full);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(mean(seen.pixels, c), 3 * std::exp(-double{absorption[c]}), 1e-5);
}

// Uniform light stays uniform in a medium that only scatters, for every density and phase function.
TEST(Medium, WhiteFurnaceIsUniform) {
  SceneData scene = room(1);
  for (const float anisotropy : {0.0f, 0.6f, -0.5f}) {
    scene.medium = medium_of({0.3, 1, 3}, {}, anisotropy, {-0.8, -1, -1}, {1, 0.7, 1});
    const TracedImage image = traced(scene, kInRoom, PathTracerOptions::kAllBounces, 4096);
    const Image seen = pathtracer::traced_view(image, Show::full);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(mean(seen.pixels, c), 1, 0.01) << "anisotropy " << anisotropy;
  }
}

// A point light 0.3 m beside the same ray: L is the integral of sigma_s p I / r^2 exp(-sigma_t (t +
// r)) over the ray.
TEST(Medium, LightOfALampScatteredOnceFollowsItsIntegral) {
  SceneData scene = floor_scene(0);
  const glm::vec3 at(2, 1.5f, 0);
  scene.lights = {lamp(at, 5)};
  const float scattering = 1e-3f, absorption = 0.5f;
  scene.medium =
      medium_of(glm::vec3(scattering), glm::vec3(absorption), 0.4f, {0, 0.5, -2}, {4, 2, 2});
  const ClpvView view = view_of({0, 1.2, 0}, {1, 0, 0}, {0, 1, 0}, 1e-3f, 1, 1);
  const double extinction = scattering + absorption;
  double expected = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 4 * (i + 0.5) / kSteps;
    const glm::dvec3 offset = glm::dvec3(at) - glm::dvec3(t, 1.2, 0);
    const double r = glm::length(offset);
    expected += 4.0 / kSteps * scattering * phase(0.4, offset.x / r) * 5 / (r * r) *
                std::exp(-extinction * (t + r));
  }
  const Image seen = pathtracer::traced_view(traced(scene, view, 1, 256), Show::medium);
  EXPECT_NEAR(mean(seen.pixels, 0), expected, 2e-3 * expected);
}

// In the middle of a cube of an absorbing medium under a uniform sky, the fluence is the integral
// of exp(-sigma l) over all directions, l the way to the cube's side.
TEST(Medium, SweptLightOfASkyIsAttenuatedOnItsWay) {
  constexpr int kGrid = 16;
  constexpr float kCell = 0.25f, kSide = 3;
  const ClpvGrid grid = cascade_grids(glm::vec3(0), 1, kGrid * kCell, kGrid).front();
  const glm::vec3 middle =
      glm::vec3(grid.origin[0], grid.origin[1], grid.origin[2]) + kGrid * kCell / 2;
  const ClpvMedium medium = medium_of({}, {0.2, 0.5, 1}, 0, middle - kSide / 2, middle + kSide / 2);
  const std::unique_ptr<Basis> basis = swept_basis();
  const reference::Volume dark(kGrid, basis->size(), 3);
  const Sky sky = constant_sky(glm::vec3(1));
  const reference::Volume swept = reference::project_bins(
      reference::sweep(*basis, make_transport(TransportKind::sweep, *basis, {}, Blocking::areas),
                       {{grid, &dark, nullptr, 2, &medium}}, &sky)
          .front());
  for (int c = 0; c < 3; ++c) {
    double expected = 0;
    constexpr std::uint32_t kDirections = 1u << 14;
    for (std::uint32_t i = 0; i < kDirections; ++i) {
      const glm::dvec3 w = phase_direction({0, 0, 1}, 0, sobol_point(i, 3));
      expected += 4 * pi / kDirections *
                  transmittance(medium, medium_part(medium, glm::dvec3(middle), w, 100))[c];
    }
    double found = 0;  // mean of the eight cells around the middle
    for (int i = 0; i < 8; ++i) {
      found +=
          swept.value(c, 0, kGrid / 2 - (i & 1), kGrid / 2 - (i >> 1 & 1), kGrid / 2 - (i >> 2)) /
          8 * std::sqrt(4 * pi) / (kCell * kCell);
    }
    // Four taps spread a direction's light, and its ways with it: 4.6 % for the densest, 1 % for
    // the thinnest.
    EXPECT_NEAR(found, expected, 0.05 * expected) << "channel " << c;
  }
}

TEST(Medium, ScatteringBetweenBinsKeepsUniformLightEnergyAndMeanCosine) {
  const std::vector<SweepBin> bins = sweep_bins(1);
  for (const double g : {-0.9, 0.0, 0.3, 0.9}) {
    const Matrix scattering = scattering_matrix(g);
    double most_apart = 0;
    for (int b = 0; b < kSweepBins; ++b) {
      double to = 0, from = 0, cosine = 0;
      for (int other = 0; other < kSweepBins; ++other) {
        to += scattering(b, other), from += scattering(other, b);
        cosine += scattering(other, b) *
                  glm::dot(bins[b].directions.front().w, bins[other].directions.front().w);
      }
      EXPECT_NEAR(to, 1, 1e-12);
      EXPECT_NEAR(from, 1, 1e-12);
      most_apart = std::max(most_apart, std::abs(cosine - g));
    }
    EXPECT_LT(most_apart, 0.06) << "g " << g;  // bins are wide: 0 for g = 0
  }
}

/// Uniform radiance of 1 in a medium that only scatters, from a sky of radiance 1, swept along 96
/// directions.
struct Furnace {
  static constexpr int kGrid = 8;
  static constexpr float kCell = 0.25f;
  ClpvGrid grid = cascade_grids(glm::vec3(0), 1, kGrid* kCell, kGrid).front();
  Sky sky = constant_sky(glm::vec3(1));
  std::unique_ptr<Basis> basis = swept_basis();
  Transport transport = make_transport(TransportKind::sweep, *basis, {}, Blocking::areas);
  reference::Volume dark{kGrid, basis->size(), 3}, scattered{kGrid, kSweepBins, 3};

  reference::Volume swept(const ClpvMedium& medium) const {
    return reference::sweep(*basis, transport, {{grid, &dark, nullptr, 2, &medium, &scattered}},
                            &sky)
        .front();
  }
};

TEST(Medium, UniformLightIsAFixedPointOfASweep) {
  Furnace furnace;
  const double area = double{Furnace::kCell} * Furnace::kCell;
  for (double& source : furnace.scattered.values) source = area;
  const ClpvMedium medium = medium_of({0.1, 1, 100}, {}, 0.5f, {-0.6, -0.9, -5}, {0.4, 5, 0.9});
  for (const double value : furnace.swept(medium).values) EXPECT_NEAR(value, area, 1e-12);
}

/// A black floor below a sun, half of it in the shadow of a screen at 3 m, in a medium that absorbs
/// more than it scatters.
SceneData shafts() {
  SceneData scene = floor_scene(0);
  add_quad(scene, {-10, 3, -10}, {10, 0, 0}, {0, 0, 20}, 0);
  scene.lower = glm::vec3(-10, 0, -10), scene.upper = glm::vec3(10, 3, 10);
  scene.lights = {sun({0.3f, -1, 0.1f}, 5)};
  scene.medium =
      medium_of({0.002f, 0.003f, 0.004f}, {0.05f, 0.1f, 0.2f}, 0.3f, {-9, 0.2f, -9}, {9, 2.8f, 9});
  SceneCamera camera;
  camera.eye = {0.5f, 1.3f, 8};
  camera.forward = {0, 0, -1};
  camera.vertical_fov = 1;
  scene.cameras = {camera};
  return scene;
}

/// Difference of a frame from path tracing.
Comparison frame_error(const SceneData& scene, const RenderOptions& options, Show view,
                       const PathTracerOptions& tracing) {
  const SceneCamera& camera = scene.cameras.front();
  Frame frame(test_session(), scene, options);
  frame.render(camera);
  const Image truth = pathtracer::traced_view(
      pathtracer::trace_paths(scene, scene.lights_for(camera),
                              camera_view(camera, options.width, options.height), tracing),
      view);
  return compare(view_image(frame, view), "frame", truth, "ground truth");
}

// The edge of the shaft is seen from the side; the kernels blur it by a few pixels.
TEST(Medium, LightOfASunStopsAtItsShadows) {
  RenderOptions options;
  options.width = 320, options.height = 180;
  PathTracerOptions tracing;
  tracing.samples = 16;
  // 0.05, and 0.15 with a fifth of the pixels along both axes
  EXPECT_LT(frame_error(shafts(), options, Show::medium, tracing).nrmse.value(), 0.06);
}

// A black floor below a sun: all its indirect light comes from the medium.
TEST(Medium, ScatteredLightFallsOnSurfaces) {
  SceneData scene = floor_scene(0);
  scene.lower = glm::vec3(-10, 0, -10), scene.upper = glm::vec3(10, 3, 10);
  scene.lights = {sun({0.3f, -1, 0.1f}, 5)};
  SceneCamera camera;
  camera.eye = {0, 2.5f, 6}, camera.forward = glm::normalize(glm::vec3(0, -1, -2)),
  camera.vertical_fov = 1;
  scene.cameras = {camera};
  const glm::vec3 lower(-4, 0.5f, -4), upper(4, 2.5f, 4);
  const auto expect_near = [&](const ClpvMedium& medium, Bounces bounces, int traced_bounces) {
    scene.medium = medium;
    RenderOptions options;
    options.width = 64, options.height = 36, options.bounces = bounces;
    options.near = Near::off;  // the volumes' light
    PathTracerOptions tracing;
    tracing.samples = 512, tracing.bounces = traced_bounces;
    const Comparison error = frame_error(scene, options, Show::irradiance, tracing);
    EXPECT_LT(error.nrmse_valid.value(), 0.12);  // 0.07, and the noise of the truth
    EXPECT_NEAR(error.energy_ratio.value(), 1, 0.05);
  };
  expect_near(medium_of(glm::vec3(0.05f), glm::vec3(0.05f), 0.3f, lower, upper), Bounces::one, 1);
  expect_near(medium_of(glm::vec3(0.5f), {}, 0.3f, lower, upper), Bounces::all,
              PathTracerOptions::kAllBounces);
}

}  // namespace clpv::medium_test
