// SPDX-License-Identifier: MIT
// Blockers from a scene's triangles against known areas.
#include "pipeline/voxels/blockers.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "verify/check.hpp"

namespace clpv::blockers_test {
namespace {

using namespace test;

// The grid of `clpv check`: the same programs.
constexpr int kGrid = 9, kCorners = kGrid + 1;
constexpr std::size_t kAll = kCorners * kCorners * kCorners;
const ClpvGrid kCells = {
    {0, 0, 0}, 1, kGrid, {}};  // corners at 0..9, their cells half a metre round them

/// Shares [axis][z][y][x], by the kernels.
struct Shares {
  std::vector<float> values;
  float at(int axis, int x, int y, int z) const {
    return values[static_cast<std::size_t>(((axis * kCorners + z) * kCorners + y) * kCorners + x)];
  }
};

Shares blocked(const SceneData& scene) {
  Volume geometry(test_session(), {kGrid + 1, 3, 1}, "test: blockers");
  const SceneBuffers buffers = upload_scene(test_session(), scene);
  VoxelField(test_session(), buffers, blocker_masks(buffers, kGrid, 1, {}))
      .update(0, kCells, geometry);
  return {geometry.read(test_session())};
}

float sum(const Shares& shares, int axis) {
  const auto first = shares.values.begin() + static_cast<std::ptrdiff_t>(kAll) * axis;
  return std::accumulate(first, first + static_cast<std::ptrdiff_t>(kAll), 0.0f);
}

TEST(Blockers, AWallBlocksExactlyTheSquaresItCovers) {
  SceneData scene;
  add_quad(scene, {1.7f, -9, -9}, {0, 20, 0}, {0, 0, 20}, add_material(scene));
  const Shares shares = blocked(scene);
  for (int y = 0; y <= kGrid; ++y) {
    for (int z = 0; z <= kGrid; ++z) EXPECT_EQ(shares.at(0, 2, y, z), 1) << y << ' ' << z;
  }
  EXPECT_EQ(sum(shares, 0), kCorners * kCorners) << "one layer of corners alone";
  EXPECT_EQ(sum(shares, 1), 0);
  EXPECT_EQ(sum(shares, 2), 0);
}

TEST(Blockers, OverlappingWallsCountOnce) {
  SceneData scene;
  const unsigned material = add_material(scene);
  for (const float x : {1.6f, 1.9f, 2.3f})
    add_quad(scene, {x, -9, -9}, {0, 20, 0}, {0, 0, 20}, material);
  EXPECT_EQ(sum(blocked(scene), 0), kCorners * kCorners);
}

TEST(Blockers, BlockingIsProportionalToCoveredArea) {
  SceneData scene;
  add_quad(scene, {1.5f, 2.1f, 1.5f}, {0.5f, 0, 0}, {0, 0, -0.25f},
           add_material(scene));  // beyond the corner's cell
  add_quad(scene, {2.5f, 2.1f, 1.5f}, {0.5f, 0, 0}, {0, 0, 0.25f}, 0);
  const Shares shares = blocked(scene);
  EXPECT_EQ(shares.at(1, 3, 2, 2), 0.125f);
  EXPECT_EQ(shares.at(1, 2, 2, 2), 0);
  EXPECT_EQ(shares.at(1, 2, 2, 1), 0.125f);
  EXPECT_EQ(sum(shares, 1), 0.25f);
}

TEST(Blockers, ASlantedWallBlocksAlongEachAxisItCrosses) {
  SceneData scene;
  add_quad(scene, {-5, -5, -5}, {20, 20, 0}, {0, 0, 20}, add_material(scene));  // x = y
  const Shares shares = blocked(scene);
  for (int i = 0; i <= kGrid; ++i) {
    EXPECT_EQ(shares.at(0, i, i, 2), 1) << i;
    EXPECT_EQ(shares.at(1, i, i, 2), 1) << i;
  }
  EXPECT_EQ(sum(shares, 2), 0) << "seen edge-on";
}

TEST(Blockers, HolesOfMaskedMaterialsLetLightPass) {
  SceneData scene;
  Texture stripes{
      .width = 2, .height = 1, .rgba = {255, 255, 255, 255, 255, 255, 255, 0}, .name = "stripes"};
  scene.textures.push_back(stripes);
  const unsigned material = add_material(scene, glm::vec3(1), CLPV_MATERIAL_MASKED);
  scene.materials[material].texture = 0;
  scene.materials[material].alpha_cutoff = 0.5f;
  add_quad(scene, {1.5f, 2, 1.5f}, {1, 0, 0}, {0, 0, 1},
           material);  // opaque from u 0 to 1/2, repeated beyond
  EXPECT_EQ(sum(blocked(scene), 1), 0.5f);
  scene.materials[material].flags = 0;
  EXPECT_EQ(sum(blocked(scene), 1), 1) << "opaque materials ignore alpha";
}

TEST(Blockers, AHugeTriangleIsAWall) {
  SceneData scene;
  add_triangle(scene, {-3e7f, 2, -1e7f}, {3e7f, 2, -1e7f}, {0, 2, 5e7f}, add_material(scene));
  EXPECT_EQ(sum(blocked(scene), 1), kCorners * kCorners);
}

}  // namespace
}  // namespace clpv::blockers_test
