// SPDX-License-Identifier: MIT
// Voxelised triangles are the same whether computed from nothing or updated as cascades and
// triangles move.
#include "pipeline/voxels/voxel_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "pipeline/voxels/blockers.hpp"
#include "pipeline/voxels/reflectors.hpp"
#include "pipeline/voxels/visibility.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"

namespace clpv::voxel_field_test {
namespace {

using namespace test;

constexpr int kGrid = 9;  // as in `clpv check`: the same programs
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

}  // namespace
}  // namespace clpv::voxel_field_test
