// SPDX-License-Identifier: MIT
// View `cells`: which sphere a pixel shows, and its light.
#include "pipeline/raster/cells.hpp"

#include <gmock/gmock.h>

#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/load.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::cells_test {
namespace {

/// One ray along +x through the centres of a row of cells of 2 m, from outside of the grid.
ClpvView one_ray() {
  ClpvView view{};
  view.eye[0] = -3, view.eye[1] = 5, view.eye[2] = 5;
  view.forward[0] = 1, view.right[2] = 1, view.up[1] = 1;
  view.half_width = view.half_height = 0.01f;
  view.width = view.height = 1;
  return view;
}

ClpvGrid small_grid() {
  ClpvGrid grid{};
  grid.cell = 2;
  grid.n = 4;
  return grid;
}

TEST(CellSpheres, TheFirstSphereBeforeTheSurface) {
  const CellSpheres found = visible_spheres(one_ray(), {0}, small_grid());
  ASSERT_EQ(found.pixels.size(), 1u);
  EXPECT_EQ(found.centres[0], glm::dvec3(1, 5, 5)) << "the first cell is 2 cells from the eye";
  EXPECT_NEAR(glm::length(found.normals[0] - glm::dvec3(-1, 0, 0)), 0, 1e-12);
  EXPECT_TRUE(visible_spheres(one_ray(), {3.5f}, small_grid()).pixels.empty())
      << "hidden: it begins at 3.6 m";
  EXPECT_EQ(visible_spheres(one_ray(), {3.7f}, small_grid()).pixels.size(), 1u);
}

TEST(CellSpheres, NoneBesideThemAndNextToTheEye) {
  ClpvView view = one_ray();
  view.eye[1] = 5.5f;  // 0.25 cells off the centres
  EXPECT_TRUE(visible_spheres(view, {0}, small_grid()).pixels.empty());
  view = one_ray();
  view.eye[0] = 0.1f;  // in the first cell
  EXPECT_EQ(visible_spheres(view, {0}, small_grid()).centres.at(0), glm::dvec3(5, 5, 5));
  view = one_ray();
  view.forward[0] = -1, view.right[2] = -1;
  EXPECT_TRUE(visible_spheres(view, {0}, small_grid()).pixels.empty()) << "behind the eye";
}

TEST(CellSpheres, AreShadedByTheirIrradiance) {
  const SceneData scene = load_scene(kCornell);
  RenderOptions options = small_sweep();
  options.width = 64;
  options.height = 36;
  options.rsm_size = 64;
  options.cascade_size = 1;
  options.near = Near::off;  // cells have none
  Frame frame(test_session(), scene, options);
  const SceneCamera& camera = scene.camera("");
  frame.render(camera);
  const std::vector<float> depth = frame.read(Show::depth), walls = frame.read(Show::irradiance),
                           cells = frame.read(Show::cells);
  std::vector<float> depths;
  for (std::size_t i = 0; i < depth.size(); i += 4) depths.push_back(depth[i]);
  const CellSpheres spheres =
      visible_spheres(camera_view(camera, 64, 36), depths, frame.light().grids.front());
  ASSERT_GT(spheres.pixels.size(), 50u);
  std::vector<bool> covered(depths.size(), false);
  double lit = 0;
  for (const std::size_t pixel : spheres.pixels) {
    covered[pixel] = true;
    lit += cells[4 * pixel];
    EXPECT_EQ(cells[4 * pixel + 3], 1);
  }
  EXPECT_GT(lit, 0);
  for (std::size_t pixel = 0; pixel < covered.size(); ++pixel) {
    if (covered[pixel]) continue;
    EXPECT_EQ(cells[4 * pixel], walls[4 * pixel]) << pixel;
  }
  EXPECT_EQ(frame.read(Show::irradiance), walls);
}

}  // namespace
}  // namespace clpv::test::cells_test
