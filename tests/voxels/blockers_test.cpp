// SPDX-License-Identifier: MIT
// Blockers from a scene's triangles against known areas.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "pipeline/voxels/voxel_field.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "verify/check.hpp"

namespace clpv::voxels_test {

using namespace test;

constexpr int kGrid = 9;  // as in `clpv check`: the same programs
constexpr float kColour = 1.0f / 4096;
const ClpvGrid kCells = {{0, 0, 0}, 1, kGrid, {}};  // corners at 0 to 9, centres at 0.5 to 8.5

/// A wall across x that reaches through the grid, its front towards +x.
void add_wall(SceneData& scene, float x, unsigned material) {
  add_quad(scene, {x, -9, -9}, {0, 20, 0}, {0, 0, 20}, material);
}

/// A scene with an opaque and a transparent texel side by side.
SceneData scene_with_stripes() {
  SceneData scene;
  scene.textures.push_back(
      {.width = 2, .height = 1, .rgba = {255, 255, 255, 255, 0, 0, 0, 0}, .name = "stripes"});
  return scene;
}

/// Numbers [channel][z][y][x], by the kernels.
struct Field {
  int n;
  std::vector<float> values;
  float at(int channel, int x, int y, int z) const {
    return values[static_cast<std::size_t>(((channel * n + z) * n + y) * n + x)];
  }
  float sum(int channel) const {
    const std::ptrdiff_t all = std::ptrdiff_t{n} * n * n;
    const auto first = values.begin() + all * channel;
    return std::accumulate(first, first + all, 0.0f);
  }
};

/// Shares of faces that are blocked, by axis, at corners.
Field blocked(const SceneData& scene, bool only_masked = false) {
  Volume geometry(test_session(), {kGrid + 1, 3, 1}, "test: blockers");
  const SceneBuffers buffers = upload_scene(test_session(), scene);
  VoxelField(test_session(), buffers, blocker_masks(buffers, kGrid, 1, {}, only_masked))
      .update(0, kCells, geometry);
  return {kGrid + 1, geometry.read(test_session())};
}

/// Areas times albedo, by colour (of CLPV_REFLECTOR_CHANNELS) and side, at cells.
Field reflected(const SceneData& scene, bool white = false) {
  const SceneBuffers buffers = upload_scene(test_session(), scene);
  Volume reflectors(test_session(), {kGrid, kCellFaces, CLPV_REFLECTOR_CHANNELS},
                    "test: reflectors");
  VoxelField(test_session(), buffers, reflector_masks(buffers, kGrid, {}, white))
      .update(0, kCells, reflectors);
  return {kGrid, reflectors.read(test_session())};
}
constexpr int channel_of(int side, int colour) {
  return colour * kCellFaces + side;
}

TEST(Blockers, AWallBlocksExactlyTheSquaresItCovers) {
  SceneData scene;
  add_wall(scene, 1.7f, add_material(scene));
  const Field shares = blocked(scene);
  for (int y = 0; y <= kGrid; ++y) {
    for (int z = 0; z <= kGrid; ++z) EXPECT_EQ(shares.at(0, 2, y, z), 1) << y << ' ' << z;
  }
  EXPECT_EQ(shares.sum(0), (kGrid + 1) * (kGrid + 1)) << "one layer of corners alone";
  EXPECT_EQ(shares.sum(1), 0);
  EXPECT_EQ(shares.sum(2), 0);
}

TEST(Blockers, BlockingIsProportionalToCoveredArea) {
  SceneData scene;
  add_quad(scene, {1.5f, 2.1f, 1.5f}, {0.5f, 0, 0}, {0, 0, -0.25f},
           add_material(scene));  // beyond the corner's cell
  add_quad(scene, {2.5f, 2.1f, 1.5f}, {0.5f, 0, 0}, {0, 0, 0.25f}, 0);
  const Field shares = blocked(scene);
  EXPECT_EQ(shares.at(1, 3, 2, 2), 0.125f);
  EXPECT_EQ(shares.at(1, 2, 2, 2), 0);
  EXPECT_EQ(shares.at(1, 2, 2, 1), 0.125f);
  EXPECT_EQ(shares.sum(1), 0.25f);
}

TEST(Blockers, HolesOfMaskedMaterialsLetLightPass) {
  SceneData scene = scene_with_stripes();
  const unsigned material = add_material(scene, glm::vec3(1), CLPV_MATERIAL_MASKED);
  scene.materials[material].texture = 0;
  scene.materials[material].alpha_cutoff = 0.5f;
  add_quad(scene, {1.5f, 2, 1.5f}, {1, 0, 0}, {0, 0, 1},
           material);  // opaque from u 0 to 1/2, repeated beyond
  EXPECT_EQ(blocked(scene).sum(1), 0.5f);
  EXPECT_EQ(blocked(scene, true).sum(1), 0.5f);
  scene.materials[material].flags = 0;
  EXPECT_EQ(blocked(scene).sum(1), 1) << "opaque materials ignore alpha";
  EXPECT_EQ(blocked(scene, true).sum(1), 0) << "sample points see what they hide";
}

TEST(Reflectors, AWallHasItsAlbedoOnBothSides) {
  const float albedo[] = {0.8f, 0.5f, 0.25f}, cells = kGrid * kGrid;
  SceneData scene;
  add_wall(scene, 1.7f, add_material(scene, {albedo[0], albedo[1], albedo[2]}));
  const Field areas = reflected(scene);
  for (int i = 0; i < kGrid * kGrid; ++i) {
    EXPECT_NEAR(areas.at(0, 2, i % kGrid, i / kGrid), albedo[0], kColour) << i;  // 1.7 + 0.5
    EXPECT_NEAR(areas.at(1, 1, i % kGrid, i / kGrid), albedo[0], kColour) << i;  // 1.7 - 0.5
  }
  for (int colour = 0; colour < 3; ++colour) {
    for (int side = 0; side < kCellFaces; ++side)
      EXPECT_NEAR(areas.sum(channel_of(side, colour)), side < 2 ? albedo[colour] * cells : 0,
                  kColour * cells);
  }
}

TEST(Reflectors, AlbedoIsWeightedByCoveredArea) {
  SceneData scene;
  const unsigned material = add_material(scene, glm::vec3(0.5f));
  add_quad(scene, {2, 1.2f, 1}, {0.5f, 0, 0}, {0, 0, -0.25f}, material);
  EXPECT_NEAR(reflected(scene).sum(2), 0.125f * 0.5f, kColour);
  add_quad(scene, {2, 1.3f, 1}, {0.5f, 0, 0}, {0, 0, -0.25f}, add_material(scene, glm::vec3(1)));
  const Field both = reflected(scene);
  EXPECT_NEAR(both.sum(2), 0.125f * 0.75f, kColour) << "one area, of the mean albedo";
  EXPECT_NEAR(both.sum(3), 0.125f * 0.75f, kColour);
}

// A wall at 45 degrees is split into two areas, which together reflect as much light.
TEST(Reflectors, ASlantedWallSplitsIntoAreasPerAxis) {
  SceneData scene;
  add_quad(scene, {1.5f, 1.0f, 1}, {1, 1, 0}, {0, 0, 1},
           add_material(scene, glm::vec3(0.5f)));  // towards (1, -1, 0)
  const Field areas = reflected(scene);
  const float whole = 0.5f * std::sqrt(2.0f);
  for (const int side : {0, 1, 2, 3}) EXPECT_NEAR(areas.sum(side), 0.5f * whole, kColour) << side;
  EXPECT_EQ(areas.sum(4) + areas.sum(5), 0);
}

TEST(Reflectors, TexturesAndVertexColoursTintAndHolesDoNotReflect) {
  SceneData scene = scene_with_stripes();
  const unsigned material = add_material(scene, glm::vec3(0.5f));
  scene.materials[material].texture = 0;
  add_quad(scene, {1, 2.2f, 1}, {0, 0, 1}, {1, 0, 0}, material);  // up
  EXPECT_NEAR(reflected(scene).sum(2), 0.25f, 0.02f) << "half of it white";
  for (Vertex& vertex : scene.vertices) vertex.colour[1] = 0.5f;
  const Field tinted = reflected(scene);
  EXPECT_NEAR(tinted.sum(channel_of(2, 1)), 0.5f * tinted.sum(2), 2 * kColour);
  scene.materials[material].flags = CLPV_MATERIAL_MASKED;
  scene.materials[material].alpha_cutoff = 0.5f;
  EXPECT_NEAR(reflected(scene).sum(2), 0.25f, 0.06f) << "black texels are holes";
}

// The furnace has the side that a triangle faces, and both where its material is double-sided.
TEST(Reflectors, OnlyFrontsOfTheFurnaceEmit) {
  SceneData scene;
  const unsigned dark = add_material(scene, glm::vec3(0));
  add_wall(scene, 1.7f, dark);
  const Field one = reflected(scene, true);
  scene.materials[dark].flags |= CLPV_MATERIAL_DOUBLE_SIDED;
  const Field both = reflected(scene, true);
  constexpr int kFront = channel_of(0, CLPV_REFLECTOR_WHITE),
                kBack = channel_of(1, CLPV_REFLECTOR_WHITE);
  EXPECT_NEAR(one.at(kFront, 2, 1, 1), 1, kColour);
  EXPECT_EQ(one.sum(kBack), 0);
  EXPECT_NEAR(both.at(kFront, 2, 1, 1), 1, kColour);
  EXPECT_NEAR(both.at(kBack, 1, 1, 1), 1, kColour);
}

TEST(Reflectors, AlbedoIsAtMostOne) {
  SceneData scene;
  add_wall(scene, 1.7f, add_material(scene, {3, -1, 0.5f}));
  const Field areas = reflected(scene);
  EXPECT_EQ(areas.at(channel_of(0, 0), 2, 1, 1), 1);
  EXPECT_EQ(areas.at(channel_of(0, 1), 2, 1, 1), 0);
}

// Visibility between cells against closed forms: walls hide exactly the cells behind them.

/// Bytes of all points, by the kernel.
std::vector<std::uint8_t> occluded(const SceneData& scene, const ClpvGrid& grid = kCells) {
  const SceneBuffers buffers = upload_scene(test_session(), scene);
  VoxelField visibility(test_session(), buffers, visibility_masks(static_cast<int>(grid.n), 1));
  visibility.update(0, grid);
  return test_session().read<std::uint8_t>(visibility.masks(),
                                           visibility_bytes(static_cast<int>(grid.n)));
}

TEST(Visibility, AWallHidesExactlyTheCellsBehindIt) {
  constexpr unsigned kCornersWithX = 0b10101010;
  SceneData scene;
  add_wall(scene, 2.0f, add_material(scene));  // between centres at 1.5 and 2.5
  const std::vector<std::uint8_t> found = occluded(scene);
  for (std::size_t at = 0; at < found.size(); ++at) {
    const int cube = static_cast<int>(at / 64), point = static_cast<int>(at % 64);
    const glm::ivec3 cell(cube % kGrid, cube / kGrid % kGrid, cube / kGrid / kGrid);
    unsigned expected = 0;
    if (std::max({cell.x, cell.y, cell.z}) < kGrid - 1 && cell.x == 1)
      expected = point % 4 < 2 ? kCornersWithX : 0xff & ~kCornersWithX;
    ASSERT_EQ(found[at], expected) << at;
  }
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

TEST(Visibility, MaskedMaterialsAndGridsOfOneCellHideNothing) {
  SceneData scene;
  add_wall(scene, 2, add_material(scene, glm::vec3(1), CLPV_MATERIAL_MASKED));
  for (const std::uint8_t bits : occluded(scene)) ASSERT_EQ(bits, 0);
  scene.materials[0].flags = 0;
  for (const std::uint8_t bits : occluded(scene, {{1.5f, 0, 0}, 1, 1, {}})) ASSERT_EQ(bits, 0);
}

// Voxelised triangles are the same whether computed from nothing or updated as cascades and
// triangles move.

constexpr float kCell = 0.4f;

/// A grid whose first cell is `first` cells from the world's origin along each axis.
ClpvGrid grid_at(const glm::ivec3& first) {
  ClpvGrid grid{{}, kCell, kGrid, {}};
  for (int a = 0; a < 3; ++a) grid.origin[a] = kCell * static_cast<float>(first[a]);
  return grid;
}

/// Triangles of all sizes in and around a space of 20 cells; the last 40 move.
SceneData soup() {
  SceneData scene;
  const unsigned materials[] = {add_material(scene, {0.8f, 0.5f, 0.3f}),
                                add_material(scene, {0.2f, 0.7f, 0.9f})};
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto anywhere = [&](float reach) {
    return reach * glm::vec3(unit(random), unit(random), unit(random));
  };
  for (int i = 0; i < 700; ++i) {
    const glm::vec3 at = anywhere(i < 660 ? 4.0f : 1.5f);
    const float size = i % 50 == 0 ? 9.0f : i % 5 == 0 ? 1.0f : 0.2f;
    add_triangle(scene, at, at + anywhere(size), at + anywhere(size), materials[i % 2]);
  }
  scene.moving = {{3 * 660, 3 * 20, 660, 20}, {3 * 680, 3 * 20, 680, 20}};
  return scene;
}

void shift(SceneData& scene, const MeshRange& part, const glm::vec3& by) {
  for (unsigned v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
    for (int a = 0; a < 3; ++a) scene.vertices[v].position[a] += by[a];
  }
}

/// All results of voxelisation in a cascade.
struct Left {
  std::vector<std::uint8_t> occluded;
  std::vector<float> blocked, reflected;
  bool operator==(const Left&) const = default;
};

/// The three voxelising stages for two cascades; only the second moves.
class Stages {
 public:
  explicit Stages(const SceneBuffers& buffers)
      : visibility_(test_session(), buffers, visibility_masks(kGrid, 2)),
        blockers_(test_session(), buffers, blocker_masks(buffers, kGrid, 2, {})),
        reflectors_(test_session(), buffers, reflector_masks(buffers, kGrid, {})) {}

  Left bring(const ClpvGrid& grid) {
    visibility_.update(1, grid);
    blockers_.update(1, grid, geometry_);
    reflectors_.update(0, grid, reflected_);
    const std::size_t bytes = visibility_bytes(kGrid);
    const auto occluded = test_session().read<std::uint8_t>(visibility_.masks(), 2 * bytes);
    return {{occluded.begin() + static_cast<std::ptrdiff_t>(bytes), occluded.end()},
            geometry_.read(test_session()),
            reflected_.read(test_session())};
  }

 private:
  VoxelField visibility_, blockers_, reflectors_;
  Volume geometry_{test_session(), {kGrid + 1, 3, 1}, "test: geometry"};
  Volume reflected_{
      test_session(), {kGrid, kCellFaces, CLPV_REFLECTOR_CHANNELS}, "test: reflectors"};
};

Left from_nothing(const SceneData& scene, const ClpvGrid& grid) {
  return Stages(upload_scene(test_session(), scene)).bring(grid);
}

TEST(VoxelField, MoveWithACascade) {
  const SceneData scene = soup();
  Stages kept(upload_scene(test_session(), scene));
  // By one cell, by several along two and three axes, back, by more than the grid, past a base
  // (every 32 cells), by none.
  const glm::ivec3 places[] = {{-4, -4, -4}, {-3, -4, -4}, {-3, -6, -1}, {-1, -5, -2},
                               {-4, -4, -4}, {6, -4, -4},  {11, -4, 2},  {17, -4, 2},
                               {15, -4, 2},  {16, -3, 2},  {16, -3, 2}};
  for (const glm::ivec3& place : places) {
    EXPECT_TRUE(kept.bring(grid_at(place)) == from_nothing(scene, grid_at(place)))
        << place.x << " " << place.y << " " << place.z;
  }
}

TEST(VoxelField, DoNotDependOnTheOrderOfTriangles) {
  SceneData scene = soup();
  scene.moving.clear();
  const Left before = from_nothing(scene, grid_at({-4, -4, -4}));
  std::ranges::reverse(scene.triangles);
  EXPECT_TRUE(from_nothing(scene, grid_at({-4, -4, -4})) == before);
}

TEST(VoxelField, DegenerateTrianglesSetNoBits) {
  SceneData scene;
  const auto expect_none = [&] {
    const Left left = from_nothing(scene, grid_at({0, 0, 0}));
    EXPECT_EQ(std::ranges::count(left.occluded, 0), std::ssize(left.occluded));
    EXPECT_EQ(std::ranges::count(left.blocked, 0.0f), std::ssize(left.blocked));
    EXPECT_EQ(std::ranges::count(left.reflected, 0.0f), std::ssize(left.reflected));
  };
  expect_none();
  const unsigned material = add_material(scene);
  add_triangle(scene, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, material);  // no area
  add_triangle(scene, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, material);
  add_triangle(scene, {50, 1, 1}, {60, 1, 1}, {50, 9, 9}, material);  // beside the grid
  expect_none();
}

TEST(VoxelField, FollowMovingObjects) {
  SceneData scene = soup();
  SceneBuffers buffers = upload_scene(test_session(), scene);
  Stages kept(buffers);
  glm::ivec3 place(-4, -4, -4);
  Left before = kept.bring(grid_at(place));
  for (int step = 0; step < 4; ++step) {
    shift(scene, scene.moving[static_cast<std::size_t>(step % 2)], {0.3f, -0.2f, 0.25f});
    upload_moving(test_session(), scene, buffers);
    if (step >= 2) ++place[step - 2];
    if (step == 3) {  // an instant that was not looked at
      shift(scene, scene.moving[0], {-1, 0.5f, 0});
      upload_moving(test_session(), scene, buffers);
    }
    const Left now = kept.bring(grid_at(place));
    EXPECT_TRUE(now == from_nothing(scene, grid_at(place))) << step;
    EXPECT_FALSE(now == before) << step;
    before = now;
  }
}

}  // namespace clpv::voxels_test
