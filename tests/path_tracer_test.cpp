// The path tracer against closed forms: what the pipeline is held against has to be right itself.
#include "reference/path_tracer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "on_device.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/view.hpp"
#include "scene_builder.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

using reference::PathTracerOptions;
using reference::TracedImage;
using std::numbers::pi;
using test::add_material;
using test::add_quad;
using test::directional_light;

constexpr float kOpen = std::numeric_limits<float>::infinity();

/// A view along `forward`, its half extents the tangents of half the fields of view.
ClpvView view_of(glm::vec3 eye, glm::vec3 forward, glm::vec3 up, float half, unsigned width,
                 unsigned height) {
  const glm::vec3 f = glm::normalize(forward), r = glm::normalize(glm::cross(f, up)), u = glm::cross(r, f);
  ClpvView view{};
  for (int i = 0; i < 3; ++i) {
    view.eye[i] = eye[i], view.right[i] = r[i], view.up[i] = u[i], view.forward[i] = f[i];
  }
  view.half_width = half, view.half_height = half * height / width;
  view.near_depth = 0.001f, view.far_depth = kOpen;
  view.width = width, view.height = height;
  return view;
}

TracedImage trace_paths(const Scene& scene, const ClpvView& view, const PathTracerOptions& options) {
  return reference::trace_paths(scene, scene.lights, view, options);
}

unsigned add_grey(Scene& scene, float albedo) {
  return add_material(scene, glm::vec3(albedo));
}

Light named(const char* name, const ClpvLight& data) {
  return {name, data};
}
Light sun(const glm::vec3& direction, float irradiance) {
  return named("sun", directional_light(direction, glm::vec3(irradiance)));
}
Light lamp(const glm::vec3& position, float intensity) {
  return named("lamp", test::point_light(position, glm::vec3(intensity)));
}

/// A unit cube seen from inside, faces inwards.
Scene box(float albedo, float emitted) {
  Scene scene;
  scene.path = "box";
  add_grey(scene, albedo);
  for (float& e : scene.materials[0].emissive) e = emitted;
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  add_quad(scene, {0, 0, 0}, z, x, 0), add_quad(scene, {0, 1, 0}, x, z, 0);
  add_quad(scene, {0, 0, 0}, y, z, 0), add_quad(scene, {1, 0, 0}, z, y, 0);
  add_quad(scene, {0, 0, 0}, x, y, 0), add_quad(scene, {0, 0, 1}, y, x, 0);
  return scene;
}

/// A horizontal square of edge 2 `half` round (0, height, 0), facing up.
void add_floor(Scene& scene, float half, float height, std::uint32_t material) {
  add_quad(scene, {-half, height, -half}, {0, 0, 2 * half}, {2 * half, 0, 0}, material);
}

Scene floor_scene(float albedo) {
  Scene scene;
  scene.path = "floor";
  add_grey(scene, albedo);
  add_floor(scene, 10, 0, 0);
  return scene;
}

const ClpvView kDown = view_of({0, 2, 0}, {0, -1, 0}, {0, 0, -1}, 0.5f, 9, 7);

/// Where the centre of a pixel of kDown meets the floor.
glm::dvec2 on_floor(unsigned px, unsigned py) {
  const double sx = (2 * (px + 0.5) / kDown.width - 1) * kDown.half_width;
  const double sy = (1 - 2 * (py + 0.5) / kDown.height) * kDown.half_height;
  return {2 * sx, -2 * sy};
}

double mean(const std::vector<glm::vec3>& values) {
  double sum = 0;
  for (const glm::vec3& v : values) sum += (v.x + v.y + v.z) / 3.0;
  return sum / values.size();
}

// A closed box whose walls emit E and reflect a: radiance E / (1 - a) everywhere, E (1 + a) after one bounce.
TEST(PathTracer, FurnaceHasTheRadianceOfAGeometricSeries) {
  for (const float albedo : {0.0f, 0.5f, 0.8f}) {
    const Scene scene = box(albedo, 2);
    const ClpvView view = view_of({0.4, 0.5, 0.6}, {0.3, 0.1, -1}, {0, 1, 0}, 1, 8, 8);
    PathTracerOptions options;
    options.emissive_lights = true;
    options.samples = 4096;
    options.bounces = PathTracerOptions::kAllBounces;
    const TracedImage all = trace_paths(scene, view, options);
    const double radiance = mean(all.emissive) + albedo / pi * mean(all.irradiance);
    EXPECT_NEAR(radiance, 2 / (1 - albedo), 0.005 * 2 / (1 - albedo)) << "albedo " << albedo;
    options.bounces = 1;
    for (const glm::vec3& e : trace_paths(scene, view, options).irradiance) EXPECT_NEAR(e.x, 2 * pi, 1e-4);
  }
}

TEST(PathTracer, EmissiveSurfacesShowButDoNotLight) {
  Scene scene = box(0.5, 2);
  scene.lights = {sun({0, -1, 0}, 1)};  // shut out by the box
  PathTracerOptions options;
  options.samples = 8;
  const TracedImage image =
      trace_paths(scene, view_of({0.5, 0.5, 0.5}, {0, 0, -1}, {0, 1, 0}, 1, 4, 4), options);
  EXPECT_EQ(mean(image.emissive), 2);
  EXPECT_EQ(mean(image.direct), 0);
  EXPECT_EQ(mean(image.irradiance), 0);
  EXPECT_EQ(image.noise, 0);
}

TEST(PathTracer, PointLightOverAFloorFallsOffAsItShould) {
  Scene scene = floor_scene(0.5);
  scene.lights = {lamp({0.3f, 1.5f, -0.2f}, 7)};
  PathTracerOptions options;
  options.samples = 4;
  const TracedImage image = trace_paths(scene, kDown, options);
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

TEST(PathTracer, RangeAndConeOfASpotBoundItsLight) {
  Scene scene = floor_scene(0.5);
  const double inner = std::cos(0.2), outer = std::cos(0.5);
  Light spot = named("spot", test::spot_light({0, 1, 0}, {0, -1, 0}, 0.2f, 0.5f));
  for (float& i : spot.data.intensity) i = 3;
  spot.data.range = 1.1f;
  scene.lights = {spot};
  PathTracerOptions options;
  options.samples = 1;
  const TracedImage image = trace_paths(scene, kDown, options);
  int full = 0, partial = 0, dark = 0;
  for (unsigned py = 0; py < kDown.height; ++py) {
    for (unsigned px = 0; px < kDown.width; ++px) {
      const double distance = std::hypot(glm::length(on_floor(px, py)), 1.0), cosine = 1 / distance;
      const double cone = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
      const double expected = distance > 1.1 ? 0.0 : 3 * cone * cone * cosine / (distance * distance);
      EXPECT_NEAR(image.direct[py * kDown.width + px].x, expected, 1e-4) << px << "," << py;
      ++(cone == 1 ? full : expected > 0 ? partial : dark);
    }
  }
  EXPECT_GT(full, 0);
  EXPECT_GT(partial, 0);
  EXPECT_GT(dark, 0);
  EXPECT_TRUE(std::isnan(image.noise)) << "one sample says nothing about noise";
}

/// Configuration factor from an element to a parallel rectangle a x b whose corner is right across it, at
/// distance 1.
double corner_factor(double a, double b) {
  const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
  return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * pi);
}

/// A floor of albedo .6, 3 x 2, under a slanting sun, and 1 above it a small tile facing down, its shadow
/// elsewhere.
Scene plates() {
  Scene scene;
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
         (corner_factor(1, 0.5) + corner_factor(1, 1.5) + corner_factor(2, 0.5) + corner_factor(2, 1.5));
}

TEST(PathTracer, ParallelPlatesExchangeTheAnalyticFormFactor) {
  PathTracerOptions options;
  options.samples = 1 << 14;
  const TracedImage image = trace_paths(plates(), kUnderTile, options);
  for (const glm::vec3& e : image.irradiance) EXPECT_NEAR(e.x, plates_expected(), 2e-3 * plates_expected());
  EXPECT_EQ(mean(image.direct), 0) << "the sun is behind the tile";
  EXPECT_LT(image.noise, 2e-3);
}

// Unbiased: many short runs average to what one long run gives, and the noise reported is the noise there is.
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
  Scene scene = box(0.7f, 0);
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

/// 2 x 2 texels: opaque red, a hole; a hole, opaque green at sRGB 188 (linear .503).
Texture checker() {
  Texture texture;
  texture.width = texture.height = 2;
  texture.rgba = {255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 188, 0, 255};
  return texture;
}

TEST(PathTracer, MaskedHolesLetLightAndSightThrough) {
  Scene scene = floor_scene(0.5);
  scene.textures = {checker()};
  Material& masked =
      scene.materials[add_material(scene, glm::vec3(1), CLPV_MATERIAL_MASKED | CLPV_MATERIAL_DOUBLE_SIDED)];
  masked.texture = 0;
  masked.alpha_cutoff = 0.5f;
  add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, 1);  // u along x, v along z, facing down
  scene.lights = {sun({0, -1, 0}, 1)};
  PathTracerOptions options;
  options.samples = 1;
  // The four quarters of the grid, each at its texel's centre; then the floor below them, from beside.
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

TEST(PathTracer, TexturesAreFilteredAndWrapped) {
  Scene scene = floor_scene(1);
  Texture texture;
  texture.width = 4, texture.height = 1;
  texture.wrap_u = CLPV_WRAP_MIRROR;
  texture.rgba = {0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255};
  scene.textures = {texture};
  scene.materials[0].texture = 0;
  scene.lights = {sun({0, -1, 0}, 1)};
  // u from 0 to 4 over the floor's 20 m: texels of 1.25 m, a period of 10 m.
  for (Vertex& v : scene.vertices) v.uv[0] = (v.position[0] + 10) / 5, v.uv[1] = 0;
  PathTracerOptions options;
  options.samples = 1;
  const ClpvView view = view_of({0, 10, 0}, {0, -1, 0}, {0, 0, -1}, 1, 64, 1);
  const TracedImage image = trace_paths(scene, view, options);
  for (unsigned px = 0; px < 64; ++px) {
    const double x = (2 * (px + 0.5) / 64 - 1) * 10 + 10;
    const double mirrored = std::fmod(x, 10) < 5 ? std::fmod(x, 5) : 5 - std::fmod(x, 5);
    const double expected = std::clamp(mirrored / 1.25 - 1.5, 0.0, 1.0);
    EXPECT_NEAR(image.albedo[px].x, expected, 1e-4) << px;
  }
}

TEST(PathTracer, SingleSidedSurfacesAreSeenFromTheirFrontAndShadeFromBoth) {
  Scene scene = floor_scene(0.5);
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

TEST(PathTracer, BackgroundIsZero) {
  Scene scene = floor_scene(0.5);
  scene.lights = {sun({0, -1, 0}, 1)};
  PathTracerOptions options;
  options.samples = 2;
  const TracedImage image = trace_paths(scene, view_of({0, 1, 0}, {0, 1, 0}, {0, 0, 1}, 1, 3, 3), options);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(image.depth[i], 0);
    EXPECT_EQ(image.normal[i], glm::vec3(0));
    EXPECT_EQ(image.direct[i], glm::vec3(0));
    EXPECT_EQ(image.irradiance[i], glm::vec3(0));
  }
}

/// Random triangles with bent normals and random textures: plain, with holes, seen from both sides or one.
Scene clutter() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-1, 1);
  Scene scene;
  scene.path = "clutter";
  Texture texture;
  texture.width = 64, texture.height = 32;
  texture.wrap_v = CLPV_WRAP_MIRROR;
  for (unsigned i = 0; i < 4 * 64 * 32; ++i) texture.rgba.push_back(static_cast<std::uint8_t>(random()));
  scene.textures = {texture};
  for (const unsigned flags :
       {0u, CLPV_MATERIAL_MASKED | CLPV_MATERIAL_DOUBLE_SIDED, CLPV_MATERIAL_DOUBLE_SIDED}) {
    Material& material = scene.materials[add_material(scene, {0.9f, 0.8f, 0.7f}, flags)];
    material.texture = 0;
    material.alpha_cutoff = 0.5f;
  }
  for (unsigned t = 0; t < 90; ++t) {
    const glm::vec3 centre(6 * any(random), 4 * any(random), -8 + 5 * any(random));
    test::add_triangle(scene, centre + glm::vec3(any(random), 2, any(random)),
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
TEST(PathTracer, SeesWhatTheRasteriserSees) {
  const Scene scene = clutter();
  const ClpvView view = camera_view(Camera{}, 160, 90);
  PathTracerOptions options;
  options.samples = 1;
  const TracedImage traced = trace_paths(scene, view, options);
  Session& session = test::test_session();
  Rasterizer rasterizer(session, upload_scene(session, scene));
  Surface surface = make_surface(session, view, RsmFormat::float32, true);
  rasterizer.rasterize_camera(surface);
  const SurfaceImage drawn = read_surface(session, surface);
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

ExitCode refusal(const Scene& scene, const PathTracerOptions& options = {}) {
  try {
    trace_paths(scene, kDown, options);
  } catch (const Error& error) {
    return error.code();
  }
  return ExitCode::ok;
}

TEST(PathTracer, RefusesWhatItCannotTrace) {
  Scene scene = floor_scene(0.5);
  EXPECT_EQ(refusal(scene), ExitCode::bad_input) << "no light";
  scene.lights = {sun({0, -1, 0}, 1)};
  PathTracerOptions options;
  options.noise = 0;
  EXPECT_EQ(refusal(scene, options), ExitCode::usage);
  Scene bad = scene;
  bad.vertices[2].position[1] = std::nanf("");
  EXPECT_EQ(refusal(bad), ExitCode::bad_input);
  bad = scene;
  bad.materials[0].base_colour[1] = kOpen;
  EXPECT_EQ(refusal(bad), ExitCode::bad_input);
  bad = scene;
  bad.lights[0].data.intensity[0] = std::nanf("");
  EXPECT_EQ(refusal(bad), ExitCode::bad_input);
  bad = scene;
  bad.triangles[0].vertex[1] = 99;
  EXPECT_EQ(refusal(bad), ExitCode::bad_input);
  bad = scene;
  bad.triangles.clear();
  EXPECT_EQ(refusal(bad), ExitCode::bad_input);
}

}  // namespace
}  // namespace clpv
