// SPDX-License-Identifier: MIT
// Views of a frame: the space they cover, and steps of whole texels as a cascade moves.

#include "pipeline/raster/view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/paint.hpp"
#include "reference/view.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::view_test {

namespace {

using reference::project;
using test::directional_light;
using test::point_light;
using test::spot_light;

constexpr int kSize = 64;
const Bounds kBounds{glm::vec3(-20, -1, -12), glm::vec3(18, 15, 11)};

glm::dvec3 vector(const float v[3]) {
  return {v[0], v[1], v[2]};
}

std::vector<glm::vec3> directions(int count) {
  std::mt19937 random(2);
  std::normal_distribution<float> normal;
  std::vector<glm::vec3> all{{0, -1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, {1, 1, 1}};
  while (all.size() < static_cast<std::size_t>(count)) {
    all.push_back(glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));
  }
  return all;
}

std::vector<glm::dvec3> corners(const glm::dvec3& lower, const glm::dvec3& upper) {
  std::vector<glm::dvec3> all;
  for (int i = 0; i < 8; ++i) {
    all.emplace_back(i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y,
                     i & 4 ? upper.z : lower.z);
  }
  return all;
}

/// Whether a point falls on the view, `spare` pixels inside its border.
bool on_screen(const ClpvView& view, const glm::dvec3& point, double spare = 0) {
  const reference::ProjectedPoint p = project(view, point);
  return p.pixel.x >= spare - 0.5 && p.pixel.y >= spare - 0.5 &&
         p.pixel.x <= view.width - 0.5 - spare && p.pixel.y <= view.height - 0.5 - spare &&
         (view.orthographic != 0 || p.depth > 0);
}

void expect_orthonormal(const ClpvView& view) {
  const glm::dvec3 right = vector(view.right), up = vector(view.up), forward = vector(view.forward);
  EXPECT_LT(glm::length(glm::cross(right, up) + forward), 1e-6);
  EXPECT_NEAR(glm::length(right), 1, 1e-6);
  EXPECT_NEAR(glm::length(up), 1, 1e-6);
}

TEST(View, DirectionalRsmCoversTheCascadeAndStartsBeforeTheScene) {
  for (const glm::vec3& direction : directions(60)) {
    for (const ClpvGrid& grid : cascade_grids({-9.5f, 1.6f, -1.1f}, 3, 12.5, 32)) {
      const ClpvView view =
          directional_rsm_view(directional_light(direction), grid, kBounds, kSize);
      expect_orthonormal(view);
      const glm::dvec3 lower = vector(grid.origin) - 0.5 * grid.cell;
      const glm::dvec3 upper = lower + (grid.n + 1.0) * grid.cell;
      for (const glm::dvec3& corner : corners(lower, upper))
        EXPECT_TRUE(on_screen(view, corner, -1e-3));
      for (const glm::dvec3& corner :
           corners(glm::dvec3(kBounds.lower), glm::dvec3(kBounds.upper))) {
        const double depth = project(view, corner).depth;
        EXPECT_GT(depth, view.near_depth);
        EXPECT_LT(depth, view.far_depth);
      }
    }
  }
}

TEST(View, DirectionalRsmMovesByWholeTexels) {
  for (const glm::vec3& direction : directions(20)) {
    const ClpvLight light = directional_light(direction);
    const ClpvView first = directional_rsm_view(light, {{0, 0, 0}, 0.25f, 32, {}}, kBounds, kSize);
    for (int step = 1; step < 40; ++step) {
      const float by = 0.25f * static_cast<float>(step);
      const ClpvView moved =
          directional_rsm_view(light, {{by, -by, 2 * by}, 0.25f, 32, {}}, kBounds, kSize);
      ASSERT_EQ(moved.half_width, first.half_width);
      ASSERT_EQ(moved.half_height, first.half_height);
      const glm::dvec2 texels =
          project(first, vector(moved.eye)).pixel - project(first, vector(first.eye)).pixel;
      EXPECT_NEAR(texels.x, std::round(texels.x), 1e-4);
      EXPECT_NEAR(texels.y, std::round(texels.y), 1e-4);
      EXPECT_NEAR(project(first, vector(moved.eye)).depth, 0,
                  1e-5);  // in the same plane across the light
    }
  }
}

TEST(View, SpotSeesItsConeAndNotMuchMore) {
  const float outer = 0.7f;
  for (const glm::vec3& direction : directions(12)) {
    const ClpvLight light = spot_light({1, 2, 3}, direction, 0.3f, outer);
    const ClpvView view = spot_view(light, kSize, kBounds);
    expect_orthonormal(view);
    EXPECT_NEAR(view.half_width, std::tan(outer), 1e-5);
    const glm::dvec3 along = vector(light.direction), across = vector(view.right);
    for (int turn = 0; turn < 12; ++turn) {
      const double angle = turn * glm::two_pi<double>() / 12;
      const glm::dvec3 side = std::cos(angle) * across + std::sin(angle) * vector(view.up);
      EXPECT_TRUE(
          on_screen(view, vector(view.eye) + along + 0.999 * std::tan(double{outer}) * side));
    }
  }
}

TEST(View, WideSpotsTakeSixViews) {
  const ClpvLight narrow = spot_light({0, 5, 0}, {0, -1, 0}, 0.2f, 1.0f);
  const ClpvLight wide = spot_light({0, 5, 0}, {0, -1, 0}, 0.2f, 1.5f);
  const ClpvGrid grid{{0, 0, 0}, 0.5f, 8, {}};
  EXPECT_EQ(rsm_views(narrow, grid, kBounds, kSize).size(), 1u);
  EXPECT_EQ(rsm_views(wide, grid, kBounds, kSize).size(), 6u);
  EXPECT_EQ(shadow_views(wide, kBounds, kSize).size(), 6u);
  EXPECT_THROW(spot_view(wide, kSize, kBounds), Error);
}

TEST(View, PointViewsSeeEveryDirectionOnce) {
  const ClpvLight light = point_light({1, 2, 3});
  const auto views = point_views(light, kSize, kBounds);
  for (const ClpvView& view : views) expect_orthonormal(view);
  for (const glm::vec3& direction : directions(500)) {
    if (direction == glm::vec3(1, 1, 1)) continue;  // on a border
    int seen = 0;
    for (const ClpvView& view : views)
      seen += on_screen(view, vector(view.eye) + glm::dvec3(direction)) ? 1 : 0;
    EXPECT_EQ(seen, 1) << direction.x << " " << direction.y << " " << direction.z;
  }
}

TEST(View, BoxesOutsideTheScreenAreNotVisible) {
  std::vector<ClpvView> views = {camera_view({}, 64, 32)};
  const auto six = point_views(point_light({1, 2, 3}), kSize, kBounds);
  views.insert(views.end(), six.begin(), six.end());
  views.push_back(shadow_views(directional_light({0.3f, -0.8f, 0.2f}), kBounds, kSize)[0]);
  int left_out = 0, seen = 0;
  for (const ClpvView& view : views) {
    for (const glm::vec3& direction : directions(300)) {
      for (const float size : {0.1f, 2.0f}) {
        const glm::vec3 middle = 7.0f * direction;
        const Bounds box{middle - size, middle + size};
        Boxes boxes;
        for (int a = 0; a < 3; ++a) boxes.centre[a] = {middle[a]}, boxes.half[a] = {size};
        const bool may_be = places_of(view, boxes)[0] != BoxPlace::outside;
        left_out += may_be ? 0 : 1;
        for (const glm::dvec3& corner : corners(glm::dvec3(box.lower), glm::dvec3(box.upper))) {
          const bool on = on_screen(view, corner) && project(view, corner).depth < view.far_depth;
          seen += on ? 1 : 0;
          EXPECT_TRUE(may_be || !on);
        }
      }
    }
  }
  EXPECT_GT(left_out, 1000);
  EXPECT_GT(seen, 1000);
}

TEST(View, RangeLimitsHowFarALightLooks) {
  ClpvLight light = point_light({1, 2, 3});
  EXPECT_GT(point_views(light, kSize, kBounds)[0].far_depth,
            20);  // the farthest corner of the scene
  light.range = 5;
  EXPECT_NEAR(point_views(light, kSize, kBounds)[0].far_depth, 5, 0.01);
}

TEST(View, ShadowViewOfADirectionalLightHoldsTheScene) {
  for (const glm::vec3& direction : directions(40)) {
    const auto views = shadow_views(directional_light(direction), kBounds, kSize);
    ASSERT_EQ(views.size(), 1u);
    expect_orthonormal(views[0]);
    for (const glm::dvec3& corner : corners(glm::dvec3(kBounds.lower), glm::dvec3(kBounds.upper))) {
      EXPECT_TRUE(on_screen(views[0], corner, 0.5));
      const double depth = project(views[0], corner).depth;
      EXPECT_TRUE(depth > views[0].near_depth && depth < views[0].far_depth);
    }
  }
}

// A far triangle must not coarsen the shadows of what is near; a scene without gaps keeps its
// bounds.
TEST(View, LightBoundsLeaveOutWhatIsFarBehindAGap) {
  const ClpvGrid coarsest{{-25, -25, -25}, 50.0f / 32, 32, {}};
  const auto at = [](float x, float y) { return Vertex{{x, y, 0}, {}, {}, {}}; };
  const Bounds all{glm::vec3(-7, 0, 0), glm::vec3(1e4f, 6, 0)};
  const auto upper = [&](const std::vector<Vertex>& vertices) {
    return light_bounds(vertices, all, coarsest).shadows.upper.x;
  };
  EXPECT_EQ(upper({at(-7, 0), at(5, 6), at(1e4f, 0)}), 5);
  EXPECT_EQ(upper({at(-7, 0), at(5, 6), at(8e6f, 0), at(1e30f, 0)}), 5);
  EXPECT_GT(upper({at(1e4f, 0)}), 25) << "the cascade";
  EXPECT_EQ(upper({at(60, 0), at(5, 6), at(300, 0), at(2e3f, 0)}), 1e4f) << "no gap";
  EXPECT_EQ(upper({at(5, 0)}), 1e4f) << "all in the cascade";
  EXPECT_EQ(upper({at(90, 0), at(5, 6), at(1e4f, 0)}), 90);
  const Bounds rsms = light_bounds({at(5, 6), at(1e4f, 0)}, all, coarsest).rsms;
  EXPECT_TRUE(rsms.lower.y < -26 && rsms.upper.z > 26) << "cover the cascade";
}

// View `cells`: which sphere a pixel shows, and its light.

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

}  // namespace
}  // namespace clpv::test::view_test
