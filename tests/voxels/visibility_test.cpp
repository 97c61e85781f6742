// SPDX-License-Identifier: MIT
// Visibility between cells against closed forms: walls hide exactly the cells behind them.
#include "pipeline/voxels/visibility.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "verify/check.hpp"

namespace clpv::visibility_test {
namespace {

using namespace test;

constexpr int kGrid = 9;                            // as in `clpv check`: the same programs
const ClpvGrid kCells = {{0, 0, 0}, 1, kGrid, {}};  // centres at 0.5 to 8.5

/// Bytes of all points, by the kernel.
std::vector<std::uint8_t> occluded(const SceneData& scene, const ClpvGrid& grid = kCells) {
  const SceneBuffers buffers = upload_scene(test_session(), scene);
  VoxelField visibility(test_session(), buffers, visibility_masks(static_cast<int>(grid.n), 1));
  visibility.update(0, grid);
  return test_session().read<std::uint8_t>(visibility.masks(),
                                           visibility_bytes(static_cast<int>(grid.n)));
}

/// Cube and point of a byte.
glm::ivec3 cube_of(std::size_t at) {
  const int cube = static_cast<int>(at / 64);
  return {cube % kGrid, cube / kGrid % kGrid, cube / kGrid / kGrid};
}
glm::ivec3 point_of(std::size_t at) {
  const int point = static_cast<int>(at % 64);
  return {point % 4, point / 4 % 4, point / 16};
}
bool between_centres(std::size_t at) {
  const glm::ivec3 cube = cube_of(at);
  return std::max({cube.x, cube.y, cube.z}) < kGrid - 1;
}

constexpr unsigned kCornersWithX = 0b10101010;

TEST(Visibility, AWallHidesExactlyTheCellsBehindIt) {
  SceneData scene;
  add_quad(scene, {2.0f, -9, -9}, {0, 20, 0}, {0, 0, 20},
           add_material(scene));  // between centres at 1.5 and 2.5
  const std::vector<std::uint8_t> found = occluded(scene);
  for (std::size_t at = 0; at < found.size(); ++at) {
    unsigned expected = 0;
    if (between_centres(at) && cube_of(at).x == 1)
      expected = point_of(at).x < 2 ? kCornersWithX : 0xff & ~kCornersWithX;
    ASSERT_EQ(found[at], expected) << at;
  }
}

TEST(Visibility, AWallThroughCentresHidesNothing) {
  SceneData scene;
  add_quad(scene, {1.5f, -9, -9}, {0, 20, 0}, {0, 0, 20}, add_material(scene));
  for (const std::uint8_t bits : occluded(scene)) ASSERT_EQ(bits, 0);
}

TEST(Visibility, ASmallTriangleHidesOnlyWhatLiesBehindIt) {
  SceneData scene;
  // On the segment from the centre (0.5, 0.5, 0.5) to the first point, 1/8 of a cell further along
  // each axis.
  add_quad(scene, {0.55f, 0.55f, 0.56f}, {0.02f, 0, 0}, {0, 0.02f, 0}, add_material(scene));
  std::vector<std::uint8_t> found = occluded(scene);
  EXPECT_EQ(found[0] & 1, 1) << "the first point of the first cube does not see its first corner";
  EXPECT_EQ(found[0] & ~1, 0);
  for (std::size_t at = 64; at < found.size(); ++at) ASSERT_EQ(found[at], 0) << at;
}

TEST(Visibility, TrianglesOfOneSurfaceLeaveNoGap) {
  SceneData scene;
  const unsigned material = add_material(scene);
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j)
      add_quad(scene, {2.0f, 0.1f * i, 0.1f * j}, {0, 0.1f, 0}, {0, 0, 0.1f}, material);
  }
  SceneData whole;
  add_quad(whole, {2.0f, 0, 0}, {0, 4, 0}, {0, 0, 4}, add_material(whole));
  EXPECT_EQ(occluded(scene), occluded(whole));
}

TEST(Visibility, MaskedMaterialsHideNothing) {
  SceneData scene;
  add_quad(scene, {2, -9, -9}, {0, 20, 0}, {0, 0, 20},
           add_material(scene, glm::vec3(1), CLPV_MATERIAL_MASKED));
  for (const std::uint8_t bits : occluded(scene)) ASSERT_EQ(bits, 0);
}

TEST(Visibility, NothingIsHiddenInAGridOfOneCell) {
  SceneData scene;
  add_quad(scene, {0.5f, -9, -9}, {0, 20, 0}, {0, 0, 20}, add_material(scene));
  for (const std::uint8_t bits : occluded(scene, {{0, 0, 0}, 1, 1, {}})) ASSERT_EQ(bits, 0);
}

}  // namespace
}  // namespace clpv::visibility_test
