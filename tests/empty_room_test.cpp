// SPDX-License-Identifier: MIT
// An empty room against path tracing: the error of indirect light must not grow as cells get
// smaller.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "image/compare.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/load.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::empty_room_test {
namespace {

using namespace test;

constexpr int kWidth = 120, kHeight = 68;

struct Quality {
  double nrmse, energy;  ///< energy: over the ground truth's
};

Quality quality(const SceneData& scene, const Image& truth, const std::string& basis, int grid) {
  RenderOptions options;
  options.basis = basis, options.grid = grid;
  options.cascades = scene.cascades.value(), options.cascade_size = scene.cascade_size.value();
  options.width = kWidth, options.height = kHeight;
  options.near = Near::off;  // convergence of the volumes' light
  Frame frame(test_session(), scene, options);
  frame.render(scene.camera("front"));
  const Comparison comparison = compare(view_image(frame, Show::indirect), "frame", truth, "ground truth");
  return {comparison.nrmse_valid.value(), comparison.energy_ratio.value()};
}

TEST(EmptyRoom, FinerCellsAreNoWorse) {
  const SceneData scene = load_scene(test::scene_file("empty_room.json"));
  pathtracer::PathTracerOptions traced;
  traced.noise = 0.04;
  const Image truth = traced_view(
      trace_paths(scene, scene.lights, camera_view(scene.camera("front"), kWidth, kHeight), traced),
      Show::indirect);
  const Quality coarse = quality(scene, truth, "sh3", 32), fine = quality(scene, truth, "sh3", 64);
  for (const Quality& q : {coarse, fine}) {
    EXPECT_NEAR(q.energy, 1, 0.03);
    EXPECT_LT(q.nrmse, 0.12);
  }
  // Means over 24 bins: 10 % of the light is lost, and the error is nearly twice as large.
  EXPECT_LT(fine.nrmse, 0.7 * quality(scene, truth, "bins24", 64).nrmse);
}

}  // namespace
}  // namespace clpv::empty_room_test
