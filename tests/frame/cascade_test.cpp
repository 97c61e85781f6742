// SPDX-License-Identifier: MIT
// Cascades: nested grids around the camera, on whole cells.
#include "pipeline/frame/cascade.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "options/scene_options.hpp"
#include "pipeline/sweep/sweep_tables.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::cascade_test {
namespace {

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
}  // namespace clpv::cascade_test
