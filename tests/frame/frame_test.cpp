// SPDX-License-Identifier: MIT
// Whole frames against golden images and known properties of the scenes.

#include "pipeline/frame/frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "image/compare.hpp"
#include "image/image_io.hpp"
#include "kernels/shared/normal.h"
#include "options/scene_options.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame_lights.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/view.hpp"
#include "pipeline/sweep/sweep_tables.hpp"
#include "reference/blockers.hpp"
#include "reference/near.hpp"
#include "reference/rasterize.hpp"
#include "scene/load.hpp"
#include "scene/sky.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::frame_test {

namespace fs = std::filesystem;
using test::json;
using test::scene_file;
using test::sponza;

constexpr int kWidth = 96, kHeight = 54;
// Another device rounds otherwise, which moves single pixels across edges of shadows and triangles.
constexpr double kGoldenTolerance = 0.03;

RenderOptions small_options(const SceneData& scene) {
  RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  if (scene.cascade_size) options.cascade_size = *scene.cascade_size;
  if (scene.cascades) options.cascades = *scene.cascades;
  return options;
}

Image render(const SceneData& scene, const RenderOptions& options, Show view,
             const std::string& camera = {}) {
  Frame frame(test::test_session(), scene, options);
  frame.render(scene.camera(camera));
  return view_image(frame, view);
}

/// Holds a frame against tests/golden/NAME.exr; with CLPV_WRITE_GOLDEN set, writes it instead.
void expect_golden(const Image& image, const std::string& name) {
  const fs::path path = fs::path(CLPV_SOURCE_DIR) / "tests/golden" / (name + ".exr");
  if (std::getenv("CLPV_WRITE_GOLDEN") != nullptr) return write_exr(path, image);
  const Comparison result = compare(image, "this run", read_image(path), path.string());
  EXPECT_LT(result.nrmse.value(), kGoldenTolerance) << path;
}

// A frame's stages refer to its other parts.
static_assert(!std::is_move_constructible_v<Frame> && !std::is_copy_constructible_v<Frame> &&
              !std::is_move_assignable_v<Frame> && !std::is_copy_assignable_v<Frame>);

TEST(Frame, AtriumEqualsItsGoldenImage) {
  const SceneData scene = load_scene(scene_file("atrium.json"));
  expect_golden(render(scene, small_options(scene), Show::full), "atrium");
}

TEST(Frame, CornellBoxEqualsItsGoldenImage) {
  const SceneData scene = load_scene(scene_file("cornell.json"));
  expect_golden(render(scene, small_options(scene), Show::full), "cornell");
}

TEST(Frame, SponzaEqualsItsGoldenImage) {
  if (sponza().empty()) GTEST_SKIP() << "Sponza is absent; CLPV_SPONZA names it";
  const SceneData scene = load_scene(scene_file("sponza_suns.json"), sponza());
  expect_golden(render(scene, small_options(scene), Show::indirect, "curtains"), "sponza");
}

// Maps of many lights share buffers, which hold seven maps of 512 x 512: the third sun's cascades
// were injected from the map of another.
TEST(Frame, SunsInjectTheSumOfEach) {
  SceneData scene = load_scene(scene_file("cornell.json"));
  RenderOptions options = small_options(scene);
  options.cascades = 3, options.rsm_size = 512;
  const auto injected = [&](const std::vector<SceneLight>& lights) {
    scene.lights = lights;
    std::vector<double> sums;
    Frame frame(test::test_session(), scene, options);
    frame.render(scene.cameras.front(), [&](const CascadeVolumes& volumes) {
      double& sum = sums.emplace_back(0);
      for (const float value : volumes.injected.read(test::test_session()))
        sum += double{value} / volumes.light_scale;
    });
    return sums;
  };
  std::vector<SceneLight> suns;
  for (const float x : {-0.5f, 0.1f, 0.6f})
    suns.push_back({"sun", test::directional_light({x, -0.6f, 0.6f})});
  const std::vector<double> together = injected(suns);
  std::vector<double> sum(together.size());
  for (const SceneLight& sun : suns)
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += injected({sun})[c];
  for (std::size_t c = 0; c < sum.size(); ++c) EXPECT_NEAR(together[c] / sum[c], 1, 1e-3) << c;
}

/// The Cornell box full of fog, which hides 40 walls.
SceneData foggy() {
  SceneData scene = load_scene(scene_file("cornell_fog.json"));
  for (int i = 0; i < 40; ++i)
    test::add_quad(scene, {9, -9, 9 + 0.1f * static_cast<float>(i)}, {-18, 0, 0}, {0, 18, 0}, 0);
  return scene;
}

RenderOptions tiny_options() {
  RenderOptions options;
  options.grid = 8, options.cascades = 1, options.rsm_size = options.shadow_size = 16;
  options.width = 32, options.height = 18;
  return options;
}

TEST(Frame, AfterOneThatDidNotFitTheNextIsTheSame) {
  const SceneData scene = foggy();
  const RenderOptions options = tiny_options();
  const auto draw = [&](Frame& frame, int times) {
    frame.resize(times * options.width, times * options.height);
    frame.render(scene.cameras.front());
    return frame.read(Show::full);
  };
  Device device = choose_device();
  Session unlimited(device);
  Frame whole(unlimited, scene, options);
  const std::vector<float> expected = draw(whole, 1);
  const std::size_t small = unlimited.peak_device_bytes();
  draw(whole, 10);
  constexpr std::size_t kLimits = 20;  // some fall into each of the large frame's buffers
  for (std::size_t i = 0; i < kLimits; ++i) {
    device.memory_bytes = small + (unlimited.device_bytes() - small) * i / kLimits;
    Session session(device);
    Frame frame(session, scene, options);
    EXPECT_EQ(draw(frame, 1), expected);
    for (int attempt = 0; attempt < 2; ++attempt) EXPECT_THROW(draw(frame, 10), TooLarge) << i;
    EXPECT_EQ(draw(frame, 1), expected) << i;
  }
}

TEST(Frame, FogOfOneSizeDoesNotReachIntoAnother) {
  const SceneData scene = foggy();
  const auto draw = [&](Frame& frame, int width, int height) {
    frame.resize(width, height);
    frame.render(scene.cameras.front());
    return frame.read(Show::medium);
  };
  Frame alone(test::test_session(), scene, tiny_options());
  const std::vector<float> expected = draw(alone, 32, 48);
  Frame after(test::test_session(), scene, tiny_options());
  draw(after, 48, 36);  // with as many numbers in a plane
  EXPECT_EQ(draw(after, 32, 48), expected);
}

// Volumes of 16 bits: neither daylight in lux nor candle light exceeds their range.
constexpr VolumeFormat kHalf{Layout::soa, Storage::float16};

TEST(LightScale, AFullCellIsAThousandthOfTheRange) {
  for (const float irradiance : {1e-6f, 1.0f, 1e5f}) {
    for (const float cell : {0.1f, 3.0f}) {
      const float scale =
          light_scale(kHalf, {test::directional_light({0, -1, 0}, glm::vec3(irradiance))}, cell);
      const double full = static_cast<double>(irradiance) * cell * cell / std::numbers::pi * scale;
      EXPECT_GT(full, 128) << irradiance << " W/m^2, " << cell << " m";
      EXPECT_LE(full, 257) << irradiance << " W/m^2, " << cell << " m";
      int exponent = 0;
      EXPECT_EQ(std::frexp(scale, &exponent), 0.5f) << "scaling rounds nothing";
    }
  }
}

TEST(LightScale, LampsCountWithTheirTotalFlux) {
  const float scale = light_scale(kHalf, {test::point_light({0, 1, 0}, glm::vec3(100))}, 0.4f);
  EXPECT_LE(100 * 4 * scale, 257);
}

TEST(Frame, TooLargeAGridNamesOneThatCanFit) {
  Device device = choose_device();
  device.memory_bytes = 64u << 20;
  Session session(device);
  RenderOptions options;
  options.grid = 64;
  const std::string message = test::error_of(
      ExitCode::run_time, [&] { Frame(session, load_scene(scene_file("cornell.json")), options); });
  ASSERT_THAT(message, ::testing::HasSubstr("grid: found 64, and at most "));
  const int fits =
      std::stoi(message.substr(message.find("at most ", message.find("grid: found")) + 8));
  EXPECT_TRUE(fits > 8 && fits < 64) << fits;
  options.grid = 512;
  if (device.max_alloc_bytes >> 32 == 0) GTEST_SKIP() << "a buffer of the device has below 4 GiB";
  EXPECT_THAT(
      test::error_of(
          ExitCode::device,
          [&] { Frame(test::test_session(), load_scene(scene_file("cornell.json")), options); }),
      ::testing::HasSubstr("kernels address at most 2147483647: grid 389"));
}

// Cascades: nested grids around the camera, on whole cells.

TEST(Cascade, EachIsTwiceTheFinerAndContainsIt) {
  const auto grids = cascade_grids({1.3f, -2.7f, 40.1f}, 4, 12.5, 32);
  ASSERT_EQ(grids.size(), 4u);
  for (std::size_t c = 0; c + 1 < grids.size(); ++c) {
    EXPECT_FLOAT_EQ(grids[c + 1].cell, 2 * grids[c].cell);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(grids[c + 1].origin[axis], grids[c].origin[axis]);
      EXPECT_GE(grids[c + 1].origin[axis] + 32 * grids[c + 1].cell,
                grids[c].origin[axis] + 32 * grids[c].cell);
    }
  }
}

TEST(Cascade, OriginsAreWholeCellsAndTheEyeIsInTheMiddle) {
  for (const int cells : {1, 17, 32, 33}) {
    for (const ClpvGrid& grid : cascade_grids({-3.21f, 0.4f, 7.7f}, 3, 10.0, cells)) {
      const float eye[] = {-3.21f, 0.4f, 7.7f};
      for (int axis = 0; axis < 3; ++axis) {
        const double steps = grid.origin[axis] / grid.cell;
        EXPECT_NEAR(steps, std::round(steps), 1e-4);
        const double middle = grid.origin[axis] + 0.5 * cells * grid.cell;
        EXPECT_LE(std::abs(eye[axis] - middle), grid.cell * 1.001);
      }
    }
  }
}

TEST(Cascade, RejectsCellsBelowTheResolutionOfCoordinates) {
  const std::string message = test::error_of(ExitCode::usage, [] {
    cascade_grids({1e7f, 0, 0}, 2, 12.5, 32);
  });
  EXPECT_THAT(message, ::testing::HasSubstr("cascade-size: found 12.5"));
  EXPECT_THAT(message,
              ::testing::HasSubstr("allowed here: 3200 or more"));  // floats are 1 m apart there
  for (const int count : {1, 2, 3}) {
    for (const double size : {3200.0, 3613.7}) {
      const auto grids = cascade_grids({9.9e6f, 3.3f, -1.1e6f}, count, size, 32);
      for (int c = 1; c < count; ++c) EXPECT_NO_THROW(offset_in_coarser(grids[c], grids[c - 1]));
    }
  }
  EXPECT_NO_THROW(cascade_grids({0, 0, 0}, 8, 1e-6, 512));
  EXPECT_NO_THROW(cascade_grids({1e7f, 1e7f, 1e7f}, 8, 1e7, 512));
}

/// A floor of that edge [m], and a camera in its middle.
SceneData floor_of(float edge) {
  SceneData scene;
  const float half = edge / 2;
  test::add_quad(scene, {-half, 0, -half}, {0, 0, edge}, {edge, 0, 0}, test::add_material(scene));
  scene.lower = {-half, 0, -half}, scene.upper = {half, 0, half};
  scene.cameras.emplace_back();
  return scene;
}

TEST(Cascade, TheDefaultSizeIsKeptWhereItFits) {
  for (const float edge : {10.0f, 20.0f, 37.0f})
    EXPECT_EQ(fitting_cascade_size(floor_of(edge), 3, 12.5), 12.5) << edge;
  EXPECT_EQ(fitting_cascade_size(SceneData{}, 3, 12.5), 12.5) << "nothing to hold";
}

TEST(Cascade, TheCoarsestIsFittedToTheScene) {
  for (const float edge : {0.01f, 1.0f, 5.0f, 45.0f, 700.0f}) {
    const double size = fitting_cascade_size(floor_of(edge), 3, 12.5);
    EXPECT_NEAR(4 * size, edge * 32 / 24, 1e-4 * edge) << edge;
    EXPECT_EQ(fitting_cascade_size(floor_of(edge), 1, 4 * 12.5), 4 * size) << "one cascade";
  }
}

TEST(Cascade, ItIsKnownWhetherCascadesMeetTheScene) {
  const SceneData scene = floor_of(10);
  EXPECT_TRUE(cascades_meet(scene, {0, 1, 0}, 3, 1, 32));
  EXPECT_TRUE(cascades_meet(scene, {0, 1.9f, 0}, 3, 1, 32));
  EXPECT_FALSE(cascades_meet(scene, {0, 2.3f, 0}, 3, 1, 32))
      << "the coarsest ends 2 m from the eye";
  EXPECT_FALSE(cascades_meet(SceneData{}, {0, 0, 0}, 3, 1, 32));
}

// A bare model: a floor 700 m across, without camera or light.
TEST(Cascade, ThoseThatDoNotReachTheSceneAreWarnedOf) {
  const test::TemporaryFolder folder;
  test::GltfBuilder model;
  const int position = model.accessor<float>("VEC3", {-350, 0, -350, -350, 0, 350, 350, 0, -350});
  model.mesh({{"POSITION", position}});
  model.write(folder);
  const std::string render = "render model.gltf -o a.exr --width 12 --height 9 " +
                             test::kSmallSweep + "--rsm-size 64 --shadow-size 16";
  const std::string warning = "nothing of the scene is in the cascades, which end 25 m";
  const test::Outcome fitted = test::run_here(render, folder.path()),
                      small = test::run_here(render + " --cascade-size 12.5", folder.path());
  ASSERT_EQ(fitted.exit_code + small.exit_code, 0) << fitted.err << small.err;
  EXPECT_THAT(fitted.err, ::testing::Not(::testing::HasSubstr("nothing of the scene")));
  EXPECT_THAT(small.err, ::testing::HasSubstr(warning));
}

// Smooth meshes: interpolated normals weigh light, triangles decide which side it comes from and
// what shadows them (kernels/shared/normal.h).

using namespace test;
using std::numbers::pi;

/// A quad across z of 3 x 2 m with this normal at all vertices.
SceneData tilted_quad(const glm::vec3& normal) {
  SceneData scene;
  scene.path = "smooth";
  scene.lower = {-1.5f, -1, -0.1f}, scene.upper = {1.5f, 1, 0.1f};
  add_grey(scene, 0.7f);
  add_quad(scene, {-1.5f, -1, 0}, {3, 0, 0}, {0, 2, 0}, 0);
  for (Vertex& v : scene.vertices)
    for (int c = 0; c < 3; ++c) v.normal[c] = glm::normalize(normal)[c];
  return scene;
}

TEST(Smooth, DirectLightIsWeighedByTheNormalOnTheTrianglesSide) {
  const glm::vec3 normal = glm::normalize(glm::vec3(-0.6f, 0.5f, 1));
  SceneData scene = tilted_quad(normal);
  RenderOptions options;
  options.width = options.height = 8, options.cascades = 1, options.cascade_size = 4;
  options.rsm_size = 16;
  const glm::vec3 before_both(0.2f, -0.5f, -1), behind_the_triangle(1, -1, 0.1f),
      behind_the_normal(-1, 1, -0.1f);
  for (const glm::vec3& direction : {before_both, behind_the_triangle, behind_the_normal}) {
    scene.lights = {sun(direction, 10)};
    Frame frame(test_session(), scene, options);
    frame.render(camera_at({0, 0, 1}, {0, 0, -1}));
    const double cosine =
                     direction == before_both ? -glm::dot(normal, glm::normalize(direction)) : 0,
                 expected = 0.7 / pi * 10 * cosine;
    EXPECT_NEAR(mean(frame.read(Show::direct), 0), expected, 1e-3) << direction.z;
  }
}

TEST(Smooth, AVirtualPointLightLiesOnItsTriangleWithTheLightThatItsNormalWeighs) {
  SceneData scene = tilted_quad({0, 0.5f, 1});
  const SceneLight light = sun({0.2f, -1, -1}, 10);
  const ClpvGrid cascade{{-4, -4, -4}, 0.25f, 32, {}};
  Session& session = test_session();
  const SceneBuffers buffers = upload_scene(session, scene);
  Rasterizer rasterizer(session, buffers);
  Surface rsm =
      make_surface(session, directional_rsm_view(light.data, cascade, buffers.bounds, 256),
                   RsmFormat::float32, false);
  rasterizer.rasterize_rsm(light.data, rsm);
  const SurfaceImage image = read_surface(session, rsm);
  const glm::dvec3 towards = -glm::normalize(glm::dvec3(0.2, -1, -1));
  const double weight = glm::dot(glm::normalize(glm::dvec3(0, 0.5, 1)), towards) / towards.z;
  const double texel = 4.0 * rsm.view.half_width * rsm.view.half_height / (256 * 256);  // [m^2]
  std::size_t texels = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (image.depth[i] <= 0) continue;
    ++texels;
    ASSERT_NEAR(image.normal[i].z, 1, 1e-6);
    ASSERT_NEAR(image.colour[i].x, 0.7 * 10 * texel * weight, 1e-3 * texel);
  }
  EXPECT_GT(texels, 500u);
}

TEST(Smooth, PathTracingLightsByTheTriangleAndWeighsByTheNormal) {
  const glm::vec3 normal = glm::normalize(glm::vec3(0, 2, 1));  // 63 degrees off the triangle's
  SceneData scene = tilted_quad(normal);
  const ClpvView view = view_of({0, 0, 2}, {0, 0, -1}, {0, 1, 0}, 0.2f, 8, 8);
  PathTracerOptions options;
  options.samples = 256;
  scene.sky = std::make_shared<Sky>(constant_sky(glm::vec3(1)));
  // The integral of the clamped cosine over the half of directions above the triangle.
  const double expected = pi * (1 + double{normal.z}) / 2;
  for (const glm::vec3& e : trace_paths(scene, view, options).irradiance)
    ASSERT_NEAR(e.x, expected, 0.05 * expected);
  scene.sky = nullptr;
  options.samples = 1;
  scene.lights = {sun({0, -1, 0.1f}, 1)};  // on the normal's side, behind the triangle
  for (const glm::vec3& e : trace_paths(scene, view, options).direct) ASSERT_EQ(e.x, 0);
  scene.lights = {sun({0, 0.9f, -1}, 1)};  // before the triangle, behind the normal
  for (const glm::vec3& e : trace_paths(scene, view, options).direct) ASSERT_EQ(e.x, 0);
}

TEST(Smooth, GeometricNormalsKeepTheirDirection) {
  for (int i = 0; i < 1000; ++i) {
    const double z = (i + 0.5) / 500 - 1, a = 2.4 * i, r = std::sqrt(1 - z * z);
    const glm::dvec3 n(r * std::cos(a), r * std::sin(a), z);
    const glm::vec4 stored = stored_normal(-n, n);
    ASSERT_LT(glm::length(geometric_normal(stored) - n), 1e-3) << i;
    ASSERT_EQ(stored_normal(n, n).w, 0) << "one normal";
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      glm::dvec3 n(0);
      n[axis] = sign;
      EXPECT_EQ(geometric_normal(stored_normal(glm::normalize(glm::dvec3(1, 2, 3)), n)), n);
    }
  }
}

}  // namespace clpv::frame_test
