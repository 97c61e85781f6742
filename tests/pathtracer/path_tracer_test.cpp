// SPDX-License-Identifier: MIT
// The path tracer against closed forms.
#include "pathtracer/path_tracer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "pathtracer/ray_scene.hpp"
#include "pipeline/raster/view.hpp"
#include "tests/support/drawn.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::path_tracer_test {
using std::numbers::pi;
using namespace test;

/// Point of the floor at the centre of a pixel of kDown.
glm::dvec2 on_floor(unsigned px, unsigned py) {
  const double sx = (2 * (px + 0.5) / kDown.width - 1) * kDown.half_width;
  const double sy = (1 - 2 * (py + 0.5) / kDown.height) * kDown.half_height;
  return {2 * sx, -2 * sy};
}

/// Configuration factor from an element to a parallel rectangle a x b whose corner is right across
/// it, at distance 1.
double corner_factor(double a, double b) {
  const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
  return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * pi);
}

// A closed box whose walls emit E and reflect a: radiance E / (1 - a) everywhere, E (1 + a) after
// one bounce.
TEST(PathTracer, FurnaceHasTheRadianceOfAGeometricSeries) {
  for (const float albedo : {0.0f, 0.5f, 0.8f}) {
    const SceneData scene = furnace(albedo, 2);
    const ClpvView view = view_of({0.4, 0.5, 0.6}, {0.3, 0.1, -1}, {0, 1, 0}, 1, 8, 8);
    PathTracerOptions options;
    options.samples = 4096;
    options.bounces = PathTracerOptions::kAllBounces;
    const TracedImage all = trace_paths(scene, view, options);
    const double radiance = mean(all.emissive) + albedo / pi * mean(all.irradiance);
    EXPECT_NEAR(radiance, 2 / (1 - albedo), 0.005 * 2 / (1 - albedo)) << "albedo " << albedo;
    options.bounces = 1;
    const TracedImage one = trace_paths(scene, view, options);
    EXPECT_NEAR(mean(one.irradiance), 2 * pi, 1e-3 * 2 * pi);
    for (const glm::vec3& e : one.irradiance) EXPECT_NEAR(e.x, 2 * pi, 0.02 * 2 * pi);
  }
}

/// Mean irradiance [W/m^2] of a unit square on the floor, lit by an emissive `lamp`.
double received(const std::function<void(SceneData&, unsigned material)>& add_lamp, float radiance,
                unsigned flags, int samples, glm::vec3 eye = {0, 0.5f, 0}, float half = 0.5f) {
  SceneData scene;
  scene.path = "lamp";
  const unsigned black = add_grey(scene, 0), emissive = add_material(scene, glm::vec3(0), flags);
  for (float& e : scene.materials[emissive].emissive) e = radiance;
  add_quad(scene, {-0.5f, 0, -0.5f}, {0, 0, 1}, {1, 0, 0}, black);
  add_lamp(scene, emissive);
  ClpvView view = view_of(eye, {0, -1, 0}, {0, 0, -1}, half, 16, 16);
  view.orthographic = 1;
  PathTracerOptions options;
  options.samples = static_cast<std::uint32_t>(samples);
  return mean(trace_paths(scene, view, options).irradiance);
}

void add_ceiling(SceneData& scene, unsigned material) {
  add_quad(scene, {-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, material);
}
void add_wall(SceneData& scene, unsigned material) {
  add_quad(scene, {-0.5f, 0, -0.5f}, {0, 1, 0}, {0, 0, 1}, material);
}

// Form factors by Howell's catalogue: C-11, C-14, and B-4 four times.
TEST(PathTracer, EmissiveSquaresLightByTheirFormFactors) {
  const double parallel =
      2 / pi *
      (std::log(std::sqrt(4.0 / 3)) + 2 * std::sqrt(2.0) * std::atan(std::sqrt(0.5)) - pi / 2);
  EXPECT_NEAR(parallel, 0.1998, 1e-4);
  EXPECT_NEAR(received(add_ceiling, 3, 0, 256), 3 * pi * parallel, 0.002 * 3 * pi * parallel);
  const double root = std::sqrt(2.0);
  const double perpendicular =
      (pi / 2 - root * std::atan(1 / root) + std::log(4.0 / 3 * 0.75 * 0.75) / 4) / pi;
  EXPECT_NEAR(perpendicular, 0.2000, 1e-4);
  EXPECT_NEAR(received(add_wall, 3, 0, 1024), 3 * pi * perpendicular,
              0.004 * 3 * pi * perpendicular);
  const double patch = 4 * corner_factor(0.5, 0.5);
  EXPECT_NEAR(received(add_ceiling, 3, 0, 256, {0, 0.5f, 0}, 1e-3f), 3 * pi * patch,
              0.002 * 3 * pi * patch);
}

// Few samples, many runs: no light is counted twice by direct sampling and by hits.
TEST(PathTracer, EmissionIsCountedOnceByBothSamplers) {
  for (const float height : {0.02f, 0.2f, 3.0f}) {  // light is met, either, looked for
    const auto add = [&](SceneData& scene, unsigned material) {
      add_quad(scene, {-0.5f, height, -0.5f}, {1, 0, 0}, {0, 0, 1}, material);
    };
    const double a = 0.5 / double{height};
    const double wanted = 2 * pi * 4 * corner_factor(a, a);
    EXPECT_NEAR(received(add, 2, 0, 512, {0, 0.01f, 0}, 1e-4f), wanted, 0.005 * wanted) << height;
  }
}

TEST(PathTracer, EmissiveBacksAreDarkUnlessDoubleSided) {
  const auto up = [](SceneData& scene, unsigned material) {
    add_quad(scene, {-0.5f, 1, -0.5f}, {0, 0, 1}, {1, 0, 0}, material);
  };
  EXPECT_EQ(received(up, 3, 0, 16), 0);
  const double front = received(add_ceiling, 3, 0, 256),
               both = received(up, 3, CLPV_MATERIAL_DOUBLE_SIDED, 256);
  EXPECT_NEAR(both, front, 0.005 * front);
}

TEST(PathTracer, PointLightOverAFloorFallsOffAsItShould) {
  SceneData scene = floor_scene(0.5);
  scene.lights = {lamp({0.3f, 1.5f, -0.2f}, 7)};
  PathTracerOptions options;
  options.samples = 1;
  const TracedImage image = trace_paths(scene, kDown, options);
  EXPECT_TRUE(std::isnan(image.noise)) << "noise needs two samples";
  for (unsigned py = 0; py < kDown.height; ++py) {
    for (unsigned px = 0; px < kDown.width; ++px) {
      const glm::dvec3 to(0.3 - on_floor(px, py).x, 1.5, -0.2 - on_floor(px, py).y);
      const double expected = 7 * 1.5 / std::pow(glm::length(to), 3);
      const std::size_t i = py * kDown.width + px;
      EXPECT_NEAR(image.direct[i].x, expected, 1e-5 * expected) << px << "," << py;
      EXPECT_NEAR(image.depth[i], 2, 1e-5);
      EXPECT_EQ(image.irradiance[i], glm::vec3(0)) << "a lone plane sees nothing";
    }
  }
}

/// A floor of albedo 0.6, 3 x 2, under a slanting sun, and 1 above it a small tile facing down, its
/// shadow elsewhere.
SceneData plates() {
  SceneData scene;
  scene.path = "plates";
  add_grey(scene, 0.6f);
  add_grey(scene, 0.3f);
  add_quad(scene, {-1, 0, -0.5f}, {0, 0, 2}, {3, 0, 0}, 0);
  add_quad(scene, {-0.001f, 1, -0.001f}, {0.002f, 0, 0}, {0, 0, 0.002f}, 1);
  scene.lights = {sun({1, -0.3f, 0}, 5)};
  return scene;
}

const ClpvView kUnderTile = view_of({0, 0.5f, 0}, {0, 1, 0}, {0, 0, 1}, 0.0015f, 2, 2);

double plates_expected() {
  const double lit = 5 * 0.3 / std::hypot(1.0, 0.3);
  return 0.6 * lit *
         (corner_factor(1, 0.5) + corner_factor(1, 1.5) + corner_factor(2, 0.5) +
          corner_factor(2, 1.5));
}

// The estimator is unbiased, and the reported noise is the actual noise: many short runs average to
// the closed form.
TEST(PathTracer, ShortRunsAverageToTheTruthWithTheNoiseTheyReport) {
  const double truth = plates_expected();
  PathTracerOptions options;
  options.samples = 6;
  double sum = 0, squares = 0, reported = 0;
  constexpr int kRuns = 4000;
  for (int run = 0; run < kRuns; ++run) {
    options.seed = run;
    const TracedImage image = trace_paths(plates(), kUnderTile, options);
    for (const glm::vec3& e : image.irradiance) {
      sum += e.x / (4.0 * kRuns);
      squares += (e.x - truth) * (e.x - truth) / (4.0 * kRuns);
    }
    double signal = 0;
    for (const glm::vec3& e : image.irradiance) signal += e.x * e.x / 4.0;
    reported += image.noise * image.noise * signal / kRuns;
  }
  const double standard_error = std::sqrt(squares / (4.0 * kRuns));
  EXPECT_NEAR(sum, truth, 4 * standard_error);
  EXPECT_LT(standard_error, 0.01 * truth);
  EXPECT_NEAR(std::sqrt(reported / squares), 1, 0.05);
}

TEST(PathTracer, StopsAtTheNoiseAskedFor) {
  PathTracerOptions options;
  options.noise = 0.01;
  const ClpvView view = view_of({0, 0.5f, 0}, {0, 1, 0}, {0, 0, 1}, 0.0015f, 8, 8);
  const TracedImage image = trace_paths(plates(), view, options);
  EXPECT_LE(image.noise, 0.01);
  EXPECT_GT(image.noise, 0.002) << "more paths than needed";
  EXPECT_NEAR(mean(image.irradiance), plates_expected(), 0.01 * plates_expected());
}

TEST(PathTracer, SameBytesWhateverTheThreads) {
  SceneData scene = furnace(0.7f, 0);
  scene.lights = {lamp({0.5f, 0.9f, 0.5f}, 1)};
  const ClpvView view = view_of({0.4f, 0.5f, 0.9f}, {0, 0, -1}, {0, 1, 0}, 0.9f, 40, 35);
  PathTracerOptions options;
  options.bounces = PathTracerOptions::kAllBounces;
  options.samples = 9;
  options.threads = 1;
  const TracedImage one = trace_paths(scene, view, options);
  options.threads = 2;
  const TracedImage two = trace_paths(scene, view, options);
  options.seed = 2;
  const TracedImage other = trace_paths(scene, view, options);
  EXPECT_EQ(one.irradiance, two.irradiance);
  EXPECT_EQ(one.noise, two.noise);
  EXPECT_EQ(one.rays, two.rays);
  EXPECT_NE(one.irradiance, other.irradiance);
}

/// A block of 1 x 2 x 1 m on a floor of 8 x 8 m, sun from the side, at `by`; with `far`, a triangle
/// as far away.
TracedImage trace_block(const glm::vec3& by, float far) {
  SceneData scene;
  scene.path = "block";
  add_block_on_floor(scene, by, add_grey(scene, 0.6f));
  if (far > 0) add_triangle(scene, {far, 0, 0}, {far, 8, 0}, {far, 0, 8}, 0);
  scene.lights = {sun({1, -1, -0.5f}, 10)};
  PathTracerOptions options;
  options.samples = 16;
  ClpvView view = view_of(glm::vec3(4, 4, 5) + by, {-4, -3.5f, -5}, {0, 1, 0}, 0.45f, 48, 32);
  view.near_depth = 0.05f;
  return trace_paths(scene, view, options);
}

double difference(const std::vector<glm::vec3>& found, const std::vector<glm::vec3>& expected) {
  double squares = 0, signal = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double e = double{expected[i].x}, off = double{found[i].x} - e;
    squares += off * off, signal += e * e;
  }
  return std::sqrt(squares / signal);
}

TEST(PathTracer, LightDoesNotDependOnThePlaceOrOnFarSurfaces) {
  const TracedImage still = trace_block({0, 0, 0}, 0);
  for (const float moved : {1e4f, 1e5f, 5e5f}) {
    SCOPED_TRACE(moved);
    const TracedImage there = trace_block({moved, 0, moved}, 0);
    EXPECT_LT(difference(there.direct, still.direct), 0.05);
    EXPECT_LT(difference(there.irradiance, still.irradiance), 0.05);
  }
  for (const float far : {1e4f, 8e6f}) {
    SCOPED_TRACE(far);
    const TracedImage beside = trace_block({0, 0, 0}, far);
    EXPECT_LT(difference(beside.direct, still.direct), 0.01);
    EXPECT_LT(difference(beside.irradiance, still.irradiance), 0.05);
  }
  EXPECT_THAT(error_of(ExitCode::bad_input,
                       [] {
                         trace_block({4e6f, 0, 0}, 0);
                       }),
              ::testing::HasSubstr("0.25 m apart"));
}

TEST(PathTracer, RejectsWhatItCannotTrace) {
  SceneData sound = floor_scene(0.5);
  sound.lights = {sun({0, -1, 0}, 1)};
  const auto trace = [](const SceneData& scene, const PathTracerOptions& options) {
    return [=] { trace_paths(scene, kDown, options); };
  };
  PathTracerOptions still;
  still.noise = 0;
  error_of(ExitCode::usage, trace(sound, still));
  const std::vector<std::function<void(SceneData&)>> faults = {
      [](SceneData& s) { s.lights.clear(); },
      [](SceneData& s) { s.triangles.clear(); },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    SCOPED_TRACE(i);
    SceneData bad = sound;
    faults[i](bad);
    error_of(ExitCode::bad_input, trace(bad, {}));
  }
}

// Ray casting: holes, single-sided surfaces, and the same image as the rasteriser's.

/// 2 x 2 texels: opaque red, a hole; a hole, opaque green at sRGB 188 (linear 0.503).
Texture checker() {
  Texture texture;
  texture.width = texture.height = 2;
  texture.rgba = {255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 188, 0, 255};
  return texture;
}

TEST(RayScene, MaskedHolesAreTransparent) {
  SceneData scene = floor_scene(0.5);
  scene.textures = {checker()};
  ClpvMaterial& masked = scene.materials[add_material(
      scene, glm::vec3(1), CLPV_MATERIAL_MASKED | CLPV_MATERIAL_DOUBLE_SIDED)];
  masked.texture = 0;
  masked.alpha_cutoff = 0.5f;
  add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, 1);  // u along x, v along z, facing down
  scene.lights = {sun({0, -1, 0}, 1)};
  PathTracerOptions options;
  options.samples = 1;
  // The four quarters of the grid, each at its texel's centre; then the floor below them, from
  // beside.
  const ClpvView view = view_of({0, 3, 0}, {0, -1, 0}, {0, 0, -1}, 0.5f, 2, 2);
  const TracedImage image = trace_paths(scene, view, options);
  EXPECT_NEAR(image.depth[0], 2, 1e-5);  // u = v = 1/4: red
  EXPECT_NEAR(image.depth[1], 3, 1e-5);  // u = 3/4, v = 1/4: hole
  EXPECT_NEAR(image.depth[2], 3, 1e-5);
  EXPECT_NEAR(image.depth[3], 2, 1e-5);
  EXPECT_NEAR(glm::length(image.albedo[0] - glm::vec3(1, 0, 0)), 0, 1e-6);
  EXPECT_NEAR(image.albedo[3].y, 0.5029, 1e-3) << "sRGB is decoded";
  EXPECT_GT(image.normal[0].y, 0.99) << "turned towards the viewer";
  EXPECT_NEAR(image.direct[1].x, 1, 1e-6) << "sun through the hole";

  const ClpvView below = view_of({0, 0.9f, 0}, {0, -1, 0}, {0, 0, -1}, 1 / 1.8f, 2, 2);
  const TracedImage floor = trace_paths(scene, below, options);
  EXPECT_EQ(floor.direct[0].x, 0) << "in the shadow of the red texel";
  EXPECT_NEAR(floor.direct[1].x, 1, 1e-6);
}

TEST(RayScene, SingleSidedSurfacesAreSeenFromTheirFrontAndShadeFromBoth) {
  SceneData scene = floor_scene(0.5);
  scene.lights = {sun({0, -1, 0}, 1)};
  add_grey(scene, 1);
  add_quad(scene, {-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, 1);  // faces down: unseen from above
  PathTracerOptions options;
  options.samples = 1;
  const TracedImage image = trace_paths(scene, kDown, options);
  const std::size_t centre = 3 * kDown.width + 4;
  EXPECT_NEAR(image.depth[centre], 2, 1e-5);
  EXPECT_EQ(image.direct[centre].x, 0);
  EXPECT_NEAR(image.direct[0].x, 1, 1e-6);
}

// glTF: alpha of the cutoff and above is opaque. Factor, vertices or texels have one alpha.
TEST(RayScene, AlphaOfTheCutoffIsOpaque) {
  struct Case {
    float factor, vertex;
    int texel;  // texel of the texture's alpha; -1: no texture
    float cutoff;
  };
  std::vector<Case> cases = {{0.3f, 1, -1, 0.3f},
                             {0.9f, 1, -1, 0.9f},
                             {1, 0.3f, -1, 0.3f},
                             {1, 0.7f, -1, 0.7f},
                             {1, 1, -1, 1}};
  for (const int texel : {1, 77, 128, 201, 254})
    cases.push_back({1, 1, texel, static_cast<float>(texel) / 255.0f});
  // Not a whole number of pixels: weights of all sizes.
  const ClpvView view = view_of({0.1f, 3, 0.03f}, {0.05f, -1, 0.02f}, {0, 0, -1}, 0.3f, 61, 59);
  PathTracerOptions options;
  options.samples = 1;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.cutoff);
    SceneData scene = floor_scene(0.5);
    ClpvMaterial& masked = scene.materials[add_material(
        scene, glm::vec3(1), CLPV_MATERIAL_MASKED | CLPV_MATERIAL_DOUBLE_SIDED)];
    masked.base_colour[3] = c.factor, masked.alpha_cutoff = c.cutoff;
    if (c.texel >= 0) {
      Texture texture = checker();
      for (std::size_t i = 3; i < texture.rgba.size(); i += 4)
        texture.rgba[i] = static_cast<std::uint8_t>(c.texel);
      scene.textures = {texture};
      masked.texture = 0;
    }
    add_quad(scene, {-2, 1, -2}, {0, 0, 4}, {4, 0, 0}, 1);
    for (std::size_t i = 4; i < 8; ++i) scene.vertices[i].colour[3] = c.vertex;
    scene.lights = {sun({0, -1, 0}, 1)};
    const SurfaceImage drawn = test::drawn(scene, view);
    const TracedImage traced = trace_paths(scene, view, options);
    for (std::size_t i = 0; i < traced.depth.size(); ++i) {
      ASSERT_LT(drawn.depth[i], 2.1) << "the floor shows in pixel " << i;
      ASSERT_LT(traced.depth[i], 2.1) << "the floor shows in pixel " << i;
    }
  }
}

/// Random triangles with bent normals and random textures: plain, with holes, seen from both sides
/// or one.
SceneData clutter() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-1, 1);
  SceneData scene;
  scene.path = "clutter";
  Texture texture;
  texture.width = 64, texture.height = 32;
  texture.wrap_v = CLPV_WRAP_MIRROR;
  for (unsigned i = 0; i < 4 * 64 * 32; ++i)
    texture.rgba.push_back(static_cast<std::uint8_t>(random()));
  scene.textures = {texture};
  for (const unsigned flags :
       {0u, CLPV_MATERIAL_MASKED | CLPV_MATERIAL_DOUBLE_SIDED, CLPV_MATERIAL_DOUBLE_SIDED}) {
    ClpvMaterial& material = scene.materials[add_material(scene, {0.9f, 0.8f, 0.7f}, flags)];
    material.texture = 0;
    material.alpha_cutoff = 0.5f;
  }
  for (unsigned t = 0; t < 90; ++t) {
    const glm::vec3 centre(6 * any(random), 4 * any(random), -8 + 5 * any(random));
    add_triangle(scene, centre + glm::vec3(any(random), 2, any(random)),
                 centre + glm::vec3(-2, any(random), any(random)),
                 centre + glm::vec3(2, any(random), any(random)), t % 3);
    for (unsigned i = 0; i < 3; ++i) {
      Vertex& v = scene.vertices[3 * t + i];
      const glm::vec3 bent =
          glm::normalize(glm::vec3(v.normal[0], v.normal[1], v.normal[2]) + 0.3f * any(random));
      for (int c = 0; c < 3; ++c) v.normal[c] = bent[c];
      v.uv[0] = 3 * any(random), v.uv[1] = 2 * any(random);
    }
  }
  scene.lights = {sun({0, -1, -1}, 1)};
  return scene;
}

// Pixel by pixel, or else every comparison would measure two different pictures.
TEST(RayScene, SeesWhatTheRasteriserSees) {
  const SceneData scene = clutter();
  const ClpvView view = camera_view(SceneCamera{}, 160, 90);
  PathTracerOptions options;
  options.samples = 1;
  const TracedImage traced = trace_paths(scene, view, options);
  const SurfaceImage drawn = test::drawn(scene, view);
  std::size_t seen = 0, elsewhere = 0, differ = 0;
  for (std::size_t i = 0; i < traced.depth.size(); ++i) {
    if (traced.depth[i] == 0 && drawn.depth[i] == 0) continue;
    ++seen;
    if (std::abs(traced.depth[i] - drawn.depth[i]) > 1e-4f * drawn.depth[i]) {
      ++elsewhere;  // an edge or a hole's rim, which runs within a hair of the pixel's centre
      continue;
    }
    const float normal = glm::length(traced.normal[i] - glm::vec3(drawn.normal[i]));
    const float albedo = glm::length(traced.albedo[i] - glm::vec3(drawn.colour[i]));
    if (normal > 1e-3f || albedo > 1e-3f) ++differ;
  }
  EXPECT_GT(seen, 8000u);
  EXPECT_LT(elsewhere, seen / 200);
  EXPECT_LT(differ, seen / 200);
}

}  // namespace clpv::path_tracer_test
