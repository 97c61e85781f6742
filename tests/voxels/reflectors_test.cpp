// SPDX-License-Identifier: MIT
// Face albedo of voxelised triangles against known areas.
#include "pipeline/voxels/reflectors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "verify/check.hpp"

namespace clpv::reflectors_test {
namespace {

using namespace test;

constexpr int kGrid = 9;  // as in `clpv check`: the same programs
constexpr int kCells = kGrid * kGrid * kGrid;
constexpr float kColour = 1.0f / 4096;
const ClpvGrid kGridCells = {{0, 0, 0}, 1, kGrid, {}};

/// Areas [channel][side][z][y][x], by the kernels.
struct Areas {
  std::vector<float> values;
  float at(int side, int x, int y, int z, int channel = 0) const {
    return values[static_cast<std::size_t>((channel * kCellFaces + side) * kCells +
                                           (z * kGrid + y) * kGrid + x)];
  }
  float sum(int side, int channel = 0) const {
    float total = 0;
    for (int i = 0; i < kCells; ++i)
      total += at(side, i % kGrid, i / kGrid % kGrid, i / kGrid / kGrid, channel);
    return total;
  }
};

Areas reflected(const SceneData& scene, bool white = false) {
  const SceneBuffers buffers = upload_scene(test_session(), scene);
  Volume reflectors(test_session(), {kGrid, kCellFaces, CLPV_REFLECTOR_CHANNELS},
                    "test: reflectors");
  VoxelField(test_session(), buffers, reflector_masks(buffers, kGrid, {}, white))
      .update(0, kGridCells, reflectors);
  return {reflectors.read(test_session())};
}

TEST(Reflectors, AWallHasItsAlbedoOnBothSides) {
  SceneData scene;
  add_quad(scene, {1.7f, -9, -9}, {0, 20, 0}, {0, 0, 20}, add_material(scene, {0.8f, 0.5f, 0.25f}));
  const Areas areas = reflected(scene);
  for (int i = 0; i < kGrid * kGrid; ++i) {
    EXPECT_NEAR(areas.at(0, 2, i % kGrid, i / kGrid), 0.8f, kColour) << i;  // 1.7 + 0.5
    EXPECT_NEAR(areas.at(1, 1, i % kGrid, i / kGrid), 0.8f, kColour) << i;  // 1.7 - 0.5
  }
  const float cells = kGrid * kGrid;
  for (int channel = 0; channel < 3; ++channel) {
    const float albedo = channel == 0 ? 0.8f : (channel == 1 ? 0.5f : 0.25f);
    for (int side = 0; side < kCellFaces; ++side)
      EXPECT_NEAR(areas.sum(side, channel), side < 2 ? albedo * cells : 0, kColour * cells) << side;
  }
}

TEST(Reflectors, AlbedoIsWeightedByCoveredArea) {
  SceneData scene;
  const unsigned material = add_material(scene, glm::vec3(0.5f));
  add_quad(scene, {2, 1.2f, 1}, {0.5f, 0, 0}, {0, 0, -0.25f}, material);
  EXPECT_NEAR(reflected(scene).sum(2), 0.125f * 0.5f, kColour);
  add_quad(scene, {2, 1.3f, 1}, {0.5f, 0, 0}, {0, 0, -0.25f}, add_material(scene, glm::vec3(1)));
  const Areas both = reflected(scene);
  EXPECT_NEAR(both.sum(2), 0.125f * 0.75f, kColour) << "one area, of the mean albedo";
  EXPECT_NEAR(both.sum(3), 0.125f * 0.75f, kColour);
}

// A wall at 45 degrees is split into two areas, which together reflect as much light.
TEST(Reflectors, ASlantedWallSplitsIntoAreasPerAxis) {
  SceneData scene;
  add_quad(scene, {1.5f, 1.0f, 1}, {1, 1, 0}, {0, 0, 1},
           add_material(scene, glm::vec3(0.5f)));  // towards (1, -1, 0)
  const Areas areas = reflected(scene);
  const float whole = 0.5f * std::sqrt(2.0f);
  for (const int side : {0, 1, 2, 3}) EXPECT_NEAR(areas.sum(side), 0.5f * whole, kColour) << side;
  EXPECT_EQ(areas.sum(4) + areas.sum(5), 0);
}

TEST(Reflectors, TexturesAndVertexColoursTintAndHolesDoNotReflect) {
  SceneData scene;
  scene.textures.push_back({.width = 2,
                            .height = 1,
                            .rgba = {255, 255, 255, 255, 0, 0, 0, 0},
                            .name = "white, and a black hole"});
  const unsigned material = add_material(scene, glm::vec3(0.5f));
  scene.materials[material].texture = 0;
  add_quad(scene, {1, 2.2f, 1}, {0, 0, 1}, {1, 0, 0}, material);  // up
  EXPECT_NEAR(reflected(scene).sum(2), 0.25f, 0.02f) << "half of it white";
  for (Vertex& vertex : scene.vertices) vertex.colour[1] = 0.5f;
  const Areas tinted = reflected(scene);
  EXPECT_NEAR(tinted.sum(2, 1), 0.5f * tinted.sum(2, 0), 2 * kColour);
  scene.materials[material].flags = CLPV_MATERIAL_MASKED;
  scene.materials[material].alpha_cutoff = 0.5f;
  EXPECT_NEAR(reflected(scene).sum(2), 0.25f, 0.06f) << "black texels are holes";
}

// The furnace has the side that a triangle faces, and both where its material is double-sided.
TEST(Reflectors, OnlyFrontsOfTheFurnaceEmit) {
  SceneData scene;
  const unsigned dark = add_material(scene, glm::vec3(0));
  add_quad(scene, {1.7f, -9, -9}, {0, 20, 0}, {0, 0, 20}, dark);  // towards +x
  const Areas one = reflected(scene, true);
  scene.materials[dark].flags |= CLPV_MATERIAL_DOUBLE_SIDED;
  const Areas both = reflected(scene, true);
  constexpr int kWhite = CLPV_REFLECTOR_WHITE;
  EXPECT_NEAR(one.at(0, 2, 1, 1, kWhite), 1, kColour);
  EXPECT_EQ(one.sum(1, kWhite), 0);
  EXPECT_NEAR(both.at(0, 2, 1, 1, kWhite), 1, kColour);
  EXPECT_NEAR(both.at(1, 1, 1, 1, kWhite), 1, kColour);
}

TEST(Reflectors, AlbedoIsAtMostOne) {
  SceneData scene;
  add_quad(scene, {1.7f, -9, -9}, {0, 20, 0}, {0, 0, 20}, add_material(scene, {3, -1, 0.5f}));
  const Areas areas = reflected(scene);
  EXPECT_EQ(areas.at(0, 2, 1, 1, 0), 1);
  EXPECT_EQ(areas.at(0, 2, 1, 1, 1), 0);
}

}  // namespace
}  // namespace clpv::reflectors_test
