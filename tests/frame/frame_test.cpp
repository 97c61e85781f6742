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
#include "options/scene_options.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame_lights.hpp"
#include "pipeline/raster/view.hpp"
#include "pipeline/sweep/sweep_tables.hpp"
#include "reference/blockers.hpp"
#include "reference/near.hpp"
#include "reference/rasterize.hpp"
#include "scene/load.hpp"
#include "scene/sky.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::frame_test {

namespace {

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
  Image image = make_image(options.width, options.height, {"R", "G", "B", "A"});
  image.pixels = frame.read(view);
  return image;
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

constexpr float kEdge = 2;  // half the edge of a room, open above [m]

struct Pane {
  std::string name;
  double factor;
  json colour;
  std::string mode;
  float vertex_alpha;
  bool open;
};

SceneData room_below(const Pane* pane) {
  constexpr float kTurn = 0.70710678f;
  const test::TemporaryFolder folder;
  test::GltfBuilder model;
  model.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.6, 0.6, 0.6, 1}}}}});
  model.square(kEdge)["material"] = 0;
  for (const glm::vec2 to : {glm::vec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
    model.add("nodes", {{"mesh", 0},
                        {"rotation", {-kTurn * to.y, 0, kTurn * to.x, kTurn}},
                        {"translation", {kEdge * to.x, kEdge, kEdge * to.y}}});
  }
  if (pane != nullptr) {
    model.add(
        "materials",
        {{"pbrMetallicRoughness", {{"baseColorFactor", pane->colour}}},
         {"alphaMode", pane->mode},
         {"doubleSided", true},
         {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", pane->factor}}}}}});
    std::vector<float> colours;
    for (int i = 0; i < 4; ++i) colours.insert(colours.end(), {1, 1, 1, pane->vertex_alpha});
    json& primitive = model.square(kEdge);
    primitive["material"] = 1;
    primitive["attributes"]["COLOR_0"] = model.accessor<float>("VEC4", colours);
    model.document["nodes"].back()["translation"] = {0, 2 * kEdge, 0};
  }
  SceneData scene = load_scene(model.write(folder));
  scene.lights = {{"sun", test::directional_light({0.3f, -1, 0.2f}, glm::vec3(10))}};
  scene.cameras = {test::camera_at({-1.5f, 2, 1.5f}, {1, -0.6f, -1})};
  return scene;
}

// Through what stops less than half of light the sun comes in as without a pane: in kernels, in the
// path tracer, and in the references of rays, shadow maps and blockers.
TEST(Frame, ThroughAPaneARoomIsLitAsWithoutIt) {
  struct Found {
    Image kernels, paths;
    std::vector<float> sunlit;
    std::vector<double> blocked;
    bool above;
  };
  const auto found = [](const SceneData& scene) {
    RenderOptions options = test::small_sweep();
    options.width = kWidth, options.height = kHeight, options.cascades = 1;
    pathtracer::PathTracerOptions tracing;
    tracing.samples = 4;
    const ClpvGrid grid{{-kEdge, 0, -kEdge}, kEdge / 4, 8, {}};
    const ClpvLight& sun = scene.lights[0].data;
    bool uncertain = false;
    return Found{
        render(scene, options, Show::full),
        pathtracer::traced_view(
            pathtracer::trace_paths(scene, scene.lights,
                                    camera_view(scene.cameras[0], kWidth, kHeight), tracing),
            Show::full),
        reference::rasterize_rsm(
            scene, sun, directional_rsm_view(sun, grid, {scene.lower, scene.upper}, kHeight))
            .image.depth,
        reference::voxelize_blockers(scene, grid).upper.values,
        reference::nearest_triangle(scene, reference::Materials(scene), {{0, 1, 0}, {0, 1, 0}, 10},
                                    uncertain)
            .has_value()};
  };
  constexpr double kEqual = 1e-6;  // relative; programs with the look-up of alpha may round
  const Found without = found(room_below(nullptr));
  const json clear = {1, 1, 1, 1}, thin = {1, 1, 1, 0.1}, green = {0.2, 1, 0.6, 1};
  for (const Pane& pane : {Pane{"clear glass", 1, clear, "OPAQUE", 1, true},
                           {"tinted glass", 0.9, green, "OPAQUE", 1, true},
                           {"dark glass", 0.8, green, "OPAQUE", 1, false},
                           {"blending", 0, thin, "BLEND", 1, true},
                           {"blending by vertices", 0, clear, "BLEND", 0.4f, true},
                           {"blending to a wall", 0, clear, "BLEND", 0.6f, false},
                           {"blending glass", 0.4, clear, "BLEND", 0.8f, true},
                           {"masked", 0, thin, "MASK", 1, true}}) {
    SCOPED_TRACE(pane.name);
    const Found with = found(room_below(&pane));
    const double kernels = compare(with.kernels, "with", without.kernels, "without").nrmse.value(),
                 paths = compare(with.paths, "with", without.paths, "without").nrmse.value();
    EXPECT_TRUE(pane.open ? kernels < kEqual : kernels > 0.9) << kernels;
    EXPECT_TRUE(pane.open ? paths < kEqual : paths > 0.9) << paths;
    EXPECT_EQ(with.sunlit == without.sunlit, pane.open);
    EXPECT_EQ(with.blocked == without.blocked, pane.open);
    EXPECT_NE(with.above, pane.open);
  }
}

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

TEST(Frame, ManyInOneSessionFitWhereOneDoes) {
  const SceneData scene = load_scene(scene_file("cornell.json"));
  RenderOptions options = small_options(scene);
  Device device = choose_device();
  {
    Session session(device);
    Frame(session, scene, options).render(scene.cameras.front());
    device.memory_bytes = session.peak_device_bytes() * 3 / 2;
  }
  Session session(device);
  for (const Directions directions : {Directions::of24, Directions::of96}) {
    options.coarser_directions = directions;
    Frame(session, scene, options).render(scene.cameras.front());
  }
  EXPECT_EQ(session.device_bytes(), 0u);
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
  EXPECT_GT(fits, 8);
  EXPECT_LT(fits, 64);
  options.grid = 512;
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

}  // namespace
}  // namespace clpv::frame_test
