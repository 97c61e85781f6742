// SPDX-License-Identifier: MIT
// An empty room against path tracing and a closed form: indirect light converges as cells get
// smaller.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "image/compare.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/load.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::empty_room_test {
namespace {

using namespace test;

constexpr int kWidth = 120, kHeight = 68;

struct Quality {
  double nrmse, energy;  ///< energy: over the ground truth's
};

constexpr const char* kCamera = "front";

Image traced(const SceneData& scene) {
  pathtracer::PathTracerOptions options;
  options.noise = 0.04;
  return traced_view(trace_paths(scene, scene.lights,
                                 camera_view(scene.camera(kCamera), kWidth, kHeight), options),
                     Show::indirect);
}

/// By a cascade of 64 cells, `scale` times as large as the scene's: all have the same programs.
std::unique_ptr<Frame> rendered(const SceneData& scene, const std::string& basis,
                                double scale = 1) {
  RenderOptions options;
  options.basis = basis, options.grid = 64;
  options.directions = options.coarser_directions = Directions::of384;
  options.cascades = scene.cascades.value();
  options.cascade_size = scale * scene.cascade_size.value();
  options.width = kWidth, options.height = kHeight;
  options.near = Near::off;  // convergence of the volumes' light
  auto frame = std::make_unique<Frame>(test_session(), scene, options);
  frame->render(scene.camera(kCamera));
  return frame;
}

Quality quality(Frame& frame, const Image& truth) {
  const Comparison comparison =
      compare(view_image(frame, Show::indirect), "frame", truth, "ground truth");
  return {comparison.nrmse_valid.value(), comparison.energy_ratio.value()};
}

TEST(EmptyRoom, FinerCellsConverge) {
  const SceneData scene = load_scene(test::scene_file("empty_room.json"));
  const Image truth = traced(scene);
  const Quality coarse = quality(*rendered(scene, "sh2", 2), truth),
                fine = quality(*rendered(scene, "sh2"), truth);
  for (const Quality& q : {coarse, fine}) EXPECT_NEAR(q.energy, 1, 0.03);
  EXPECT_LT(fine.nrmse, 0.9 * coarse.nrmse);
}

// Means over 24 bins blur the light, also over the white furnace.
TEST(LongEmptyRoom, HarmonicsAreBetterThanBins) {
  const SceneData scene = load_scene(test::scene_file("empty_room.json"));
  const Image truth = traced(scene);
  EXPECT_LT(quality(*rendered(scene, "sh2"), truth).nrmse,
            0.8 * quality(*rendered(scene, "bins24"), truth).nrmse);
}

// One bounce of light that falls on the floor alone: the floor is plane, so it stays dark. Four or
// nine harmonics of its cells' light, without what they lack of a clamped cosine, give it a quarter
// of the room's mean.
void expect_dark_floor(const std::string& basis) {
  SceneData scene = load_scene(test::scene_file("empty_room.json"));
  scene.lights = {{"steep", directional_light(glm::normalize(glm::vec3(0, -0.9f, 0.44f)))}};
  const std::unique_ptr<Frame> frame = rendered(scene, basis);
  const std::vector<float> light = frame->read(Show::indirect), normals = frame->read(Show::normal);
  double floor = 0, room = 0;
  int pixels = 0;
  for (std::size_t i = 0; i < light.size(); i += 4) {
    room += light[i];
    if (normals[i + 1] > 0.9f) floor += light[i], ++pixels;
  }
  EXPECT_LT(floor / pixels, 0.06 * room / (kWidth * kHeight));
}
TEST(EmptyRoom, AFloorDoesNotLightItself) {
  expect_dark_floor("sh2");
}
TEST(LongEmptyRoom, AFloorDoesNotLightItself) {
  expect_dark_floor("sh3");
}

}  // namespace
}  // namespace clpv::empty_room_test
