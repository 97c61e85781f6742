// SPDX-License-Identifier: MIT
// Near field against closed forms, by the CPU reference: emissive boxes and walls, fields that it
// must not change; and the directions.

#include "pipeline/gather/near.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "basis/sampling.hpp"
#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/gather/triangle_tree.hpp"
#include "reference/cascade_sample.hpp"
#include "reference/near.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"

namespace clpv::near_test {

using std::numbers::pi;
using namespace test;

constexpr int kGrid = 8;
constexpr float kCell = 2;   // [m]: R
constexpr int kPixels = 12;  // along each side of an image
constexpr double kRadiance = 3;

/// An image of kPixels^2 pixels: the floor y = 0 around the origin from above, `edge` [m] wide.
SurfaceImage floor_image(float edge) {
  SurfaceImage image;
  image.view.eye[1] = 1, image.view.orthographic = 1;
  image.view.right[0] = 1, image.view.up[2] = -1, image.view.forward[1] = -1;
  image.view.half_width = image.view.half_height = edge / 2;
  image.view.width = image.view.height = kPixels;
  image.view.far_depth = 10;
  image.depth.assign(kPixels * kPixels, 1.0f);
  image.normal.assign(kPixels * kPixels, glm::vec4(0, 1, 0, 0));
  return image;
}

unsigned add_emitter(SceneData& scene, unsigned flags = 0) {
  const unsigned material = add_material(scene, glm::vec3(0), flags);
  for (float& channel : scene.materials[material].emissive) channel = kRadiance;
  return material;
}

NearOptions options_for(int rays, int step = 1) {
  return {.gather = {.grid = kGrid, .gather_offset = 0.25}, .step = step, .rays = rays};
}

/// Volumes of even radiance in four cascades.
struct EvenLight {
  explicit EvenLight(double radiance) {
    const std::unique_ptr<Basis> basis = swept_basis();
    for (const ClpvGrid& grid : cascade_grids({0, 0, 0}, 4, kGrid * kCell, kGrid)) {
      grids.push_back(grid);
      volumes.emplace_back(kGrid, basis->size(), 4);
      const std::vector<double> c = basis->constant();
      reference::for_each_cell(kGrid, [&](const glm::ivec3& p) {
        for (int channel = 0; channel < 4; ++channel) {
          const double unit = channel < 3 ? radiance * grid.cell * grid.cell : 1;
          for (int i = 0; i < basis->size(); ++i)
            volumes.back().at(channel, i, p.x, p.y, p.z) = unit * c[i];
        }
      });
    }
    for (std::size_t i = 0; i < grids.size(); ++i) cascades.push_back({grids[i], &volumes[i]});
  }
  std::vector<ClpvGrid> grids;
  std::vector<reference::Volume> volumes;
  std::vector<reference::Cascade> cascades;
};

/// Irradiance of the floor [W/m^2] by the CPU reference.
std::vector<glm::dvec3> near(const SceneData& scene, const EvenLight& light,
                             const NearOptions& options,
                             const std::vector<reference::MappedLight>& lights = {},
                             float edge = 1e-3f) {
  const std::unique_ptr<Basis> basis = swept_basis();
  const SurfaceImage image = floor_image(edge);
  const reference::Materials materials(scene);
  return reference::near(
             *basis, options, {scene, materials, lights, light.cascades}, image,
             reference::gather(*basis, TransportKind::sweep, options.gather, light.cascades, image))
      .irradiance;
}

TEST(Near, EvenLightWithoutSurfacesStays) {
  SceneData scene;  // a triangle out of reach
  add_triangle(scene, {50, 50, 50}, {51, 50, 50}, {50, 51, 50}, add_material(scene));
  for (const int step : {1, 2, 4, 8}) {
    // From a place in the finest cascade to one in the next.
    for (const glm::dvec3& e : near(scene, EvenLight(kRadiance), options_for(4, step), {}, 12))
      ASSERT_NEAR(e.x, pi * kRadiance, 1e-5);
  }
}

TEST(Near, InsideAnEmissiveBoxIsPiL) {
  SceneData scene;
  const unsigned emitter = add_emitter(scene, CLPV_MATERIAL_DOUBLE_SIDED);
  add_quad(scene, {-0.5f, 0.5f, -0.5f}, {1, 0, 0}, {0, 0, 1}, emitter);
  for (const float x : {-0.5f, 0.5f})
    add_quad(scene, {x, -1, -0.5f}, {0, 1.5f, 0}, {0, 0, 1}, emitter);
  for (const float z : {-0.5f, 0.5f})
    add_quad(scene, {-0.5f, -1, z}, {1, 0, 0}, {0, 1.5f, 0}, emitter);
  // Every ray hits, so the volumes' light does not matter.
  const std::vector<glm::dvec3> found = near(scene, EvenLight(0.7), options_for(4));
  for (const glm::dvec3& e : found) ASSERT_NEAR(e.x, pi * kRadiance, 0.02 * kRadiance);
}

/// E / (pi L) of a point on a floor beside an upright rectangle `width` x `height` that begins
/// `distance` from it, at its lower corner.
double form_factor(double distance, double width, double height) {
  const double slant = std::hypot(distance, height);
  return (std::atan(width / distance) - distance / slant * std::atan(width / slant)) / (2 * pi);
}

TEST(Near, FloorBesideALitWall) {
  SceneData scene;  // the wall's front faces the origin
  const double albedo = 0.6, distance = 0.3, width = 0.5, height = 0.8;
  add_quad(scene, {0.3f, 0, -0.5f}, {0, 0, 1}, {0, 0.8f, 0},
           add_material(scene, glm::vec3(albedo)));
  const ClpvLight sun = directional_light({1, -1, 0}, glm::vec3(5));
  const double radiance = albedo / pi * 5 / std::sqrt(2.0);
  const std::vector<glm::dvec3> found = near(scene, EvenLight(0), options_for(64), {{sun, {}}});
  const double expected = pi * radiance * 2 * form_factor(distance, width, height);
  EXPECT_NEAR(mean(found), expected, 0.02 * expected);
}

TEST(Near, SingleSidedEmittersAreDarkFromBehind) {
  SceneData scene;
  add_quad(scene, {0.3f, 0, -0.5f}, {0, 0.8f, 0}, {0, 0, 1},
           add_emitter(scene));  // the front faces +x
  EXPECT_NEAR(mean(near(scene, EvenLight(0), options_for(4))), 0, 1e-9);
}

TEST(Near, BlackWallsTakeTheirShareOfEvenLight) {
  SceneData scene;
  add_quad(scene, {0.3f, 0, -0.5f}, {0, 0, 1}, {0, 0.8f, 0}, add_material(scene, glm::vec3(0)));
  const double expected = pi * kRadiance * (1 - 2 * form_factor(0.3, 0.5, 0.8));
  EXPECT_NEAR(mean(near(scene, EvenLight(kRadiance), options_for(64))), expected, 0.02 * expected);
}

TEST(Near, WhiteWallsUnderEvenLightStayWithMoreBounces) {
  SceneData scene;
  add_quad(scene, {0.3f, 0, -0.5f}, {0, 0, 1}, {0, 0.8f, 0}, add_material(scene));
  NearOptions options = options_for(4);
  options.reflects = true;
  EXPECT_NEAR(mean(near(scene, EvenLight(kRadiance), options)), pi * kRadiance, 1e-4);
}

TEST(Radiance, EvenLightHasItsRadiance) {
  const std::unique_ptr<Basis> basis = swept_basis();
  const EvenLight light(kRadiance);
  const GatherOptions options{.grid = kGrid};
  for (const glm::dvec3& at : {glm::dvec3(0), glm::dvec3(5, 1, -2), glm::dvec3(-6.5, 0, 0)}) {
    const reference::RadianceField field =
        reference::radiance_field(options, light.cascades, basis->size(), at);
    EXPECT_NEAR(reference::radiance(*basis, field, glm::normalize(glm::dvec3(1, 2, -2))).y,
                kRadiance, 1e-6);
    EXPECT_NEAR(reference::field_irradiance(*basis, field, {0, 0, 1}).z, pi * kRadiance, 1e-5);
  }
}

TEST(NearDirections, AreCosineDistributedInEachTile) {
  for (const int rays : {1, 4, 16}) {
    const auto directions = near_directions(rays);
    ASSERT_EQ(directions.size(), 16u);
    glm::dvec3 sum(0);
    std::set<int> strata;
    for (const auto& pixel : directions) {
      ASSERT_EQ(pixel.size(), static_cast<std::size_t>(rays));
      for (const glm::vec3& w : pixel) {
        EXPECT_NEAR(glm::length(w), 1, 1e-6);
        sum += glm::dvec3(w);
        strata.insert(static_cast<int>((1 - w.z * w.z) * 4));  // quarters of the disk's area
      }
    }
    sum /= 16 * rays;
    EXPECT_EQ(strata.size(), 4u);
    EXPECT_NEAR(sum.x, 0, 0.05);
    EXPECT_NEAR(sum.y, 0, 0.05);
    EXPECT_NEAR(sum.z, 2 / 3.0, 0.03);
  }
}

SceneData lit_corner() {
  SceneData scene;
  const unsigned material = add_material(scene, {0.8f, 0.6f, 0.4f});
  add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, material);
  add_quad(scene, {1, 0, -2}, {0, 0, 4}, {0, 3, 0}, material);
  scene.cameras.push_back(camera_at({-1.5f, 1.2f, 1.5f}, {1, -0.5f, -0.6f}));
  scene.lights.push_back({"sun", directional_light({1, -1, 0.2f}, glm::vec3(4))});
  scene.lower = {-2, 0, -2}, scene.upper = {2, 3, 2};
  return scene;
}

std::vector<float> irradiance_of(const SceneData& scene, const RenderOptions& options) {
  Frame frame(test_session(), scene, options);
  frame.render(scene.cameras.front());
  return frame.read(Show::irradiance);
}

void expect_equal_frames(std::initializer_list<NearSize> sizes) {
  const SceneData scene = lit_corner();
  RenderOptions options = small_sweep();
  options.width = 50, options.height = 38;  // no multiples of eight or four
  options.cascade_size = 4, options.cascades = 2;
  options.near = Near::off;
  const std::vector<float> off = irradiance_of(scene, options);
  options.near = Near::traced;
  for (const NearSize size : sizes) {
    options.near_size = size;
    const std::vector<float> on = irradiance_of(scene, options);
    EXPECT_EQ(on, irradiance_of(scene, options));
    EXPECT_NE(on, off);
  }
}

TEST(Near, FramesAreEqualToTheBit) {
  expect_equal_frames({NearSize::half, NearSize::quarter});
}
TEST(LongNear, FramesAreEqualToTheBit) {
  expect_equal_frames({NearSize::full, NearSize::eighth});
}

// The tree of triangles: its boxes cover each triangle, and it follows moving ones.
// tests/gather/near_test.cpp has rays.

/// Triangles of a tree, and the boxes of the leaves that hold them.
struct TreeWalk {
  const TriangleTree& tree;
  std::multimap<unsigned, Bounds> triangles;
  int depth = 0;

  float number(std::size_t row, int lane) const { return tree.nodes()[row][lane]; }
  void leaf(std::size_t index, const Bounds& box) {
    const TreeRow& row = tree.leaves()[index * CLPV_TREE_LEAF_ROWS + CLPV_TREE_TRIANGLES];
    for (int lane = 0; lane < CLPV_TREE_WIDTH; ++lane) {
      const TreeRow* rows = &tree.leaves()[index * CLPV_TREE_LEAF_ROWS];
      bool area = false;
      for (int i = 0; i < 3; ++i) area = area || rows[CLPV_TREE_EDGE1 + i][lane] != 0;
      if (!area) continue;
      triangles.emplace(std::bit_cast<unsigned>(row[lane]) & ~CLPV_TREE_MASKED, box);
    }
  }
  void node(std::size_t index, int level) {
    depth = std::max(depth, level);
    const std::size_t first = index * CLPV_TREE_NODE_ROWS;
    for (int lane = 0; lane < CLPV_TREE_WIDTH; ++lane) {
      Bounds box;
      for (int a = 0; a < 3; ++a) {
        box.lower[a] = number(first + CLPV_TREE_LOWER + a, lane);
        box.upper[a] = number(first + CLPV_TREE_UPPER + a, lane);
      }
      if (box.lower.x > box.upper.x) continue;  // no child
      const int child = std::bit_cast<int>(number(first + CLPV_TREE_CHILDREN, lane));
      child < 0 ? leaf(~child, box) : node(child, level + 1);
    }
  }
};

SceneData many_triangles(bool moving) {
  SceneData scene;
  const unsigned plain = add_material(scene),
                 masked = add_material(scene, glm::vec3(1), CLPV_MATERIAL_MASKED);
  for (int i = 0; i < 3000; ++i) {
    const glm::vec3 p(i % 10, i / 10 % 10, i / 100 + 0.1f * (i % 7));
    add_triangle(scene, p, p + glm::vec3(0.5f, 0, 0.2f), p + glm::vec3(0, 0.5f, 0.1f),
                 i % 5 == 0 ? masked : plain);
  }
  // Long ones across the others, in parts.
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 p(0, 0.1f * static_cast<float>(i), 0);
    add_triangle(scene, p, p + glm::vec3(10, 0, 30), p + glm::vec3(10, 0.1f, 30), plain);
  }
  if (moving) scene.moving.push_back({3 * 1000, 3 * 500, 1000, 500});
  return scene;
}

/// True if a point of a triangle lies in the box of a leaf that holds the triangle.
bool is_held(const TreeWalk& walk, unsigned triangle, const glm::vec3& p) {
  constexpr float kRounding = 1e-5f;
  const auto [first, last] = walk.triangles.equal_range(triangle);
  return std::any_of(first, last, [&](const auto& held) {
    return glm::all(glm::lessThanEqual(held.second.lower - kRounding, p)) &&
           glm::all(glm::lessThanEqual(p, held.second.upper + kRounding));
  });
}

TEST(TriangleTree, HoldsEachPointOfEachTriangle) {
  constexpr int kSteps = 20;
  const TreeLimits usual, areas{.parts = 0}, morton{.parts = 0, .areas = 0},
      medians{.parts = 0, .medians = true};
  for (const auto& [moving, limits] :
       {std::pair(false, usual), std::pair(true, usual), std::pair(false, areas),
        std::pair(true, morton), std::pair(true, medians)}) {
    const SceneData scene = many_triangles(moving);
    const TriangleTree tree(scene, limits);
    TreeWalk walk{tree, {}};
    walk.node(0, 1);
    EXPECT_EQ(walk.triangles.size() > scene.triangles.size(), limits.parts > 0);
    EXPECT_LE(walk.depth, CLPV_TREE_DEPTH);
    for (unsigned triangle = 0; triangle < scene.triangles.size(); ++triangle) {
      std::array<glm::vec3, 3> corners;
      for (int i = 0; i < 3; ++i) {
        const float* p = scene.vertices[scene.triangles[triangle].vertex[i]].position;
        corners[i] = {p[0], p[1], p[2]};
      }
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; i + j <= kSteps; ++j) {
          const glm::vec3 p = corners[0] + (static_cast<float>(i) * (corners[1] - corners[0]) +
                                            static_cast<float>(j) * (corners[2] - corners[0])) /
                                               float{kSteps};
          ASSERT_TRUE(is_held(walk, triangle, p)) << triangle;
        }
      }
    }
  }
}

bool equal_bytes(const std::vector<TreeRow>& a, const std::vector<TreeRow>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(TreeRow)) == 0;
}

TEST(TriangleTree, MovesToWhatItWouldBeFromScratch) {
  SceneData scene = many_triangles(true);
  TriangleTree tree(scene);
  for (unsigned v = 3000; v < 4500; ++v)
    scene.vertices[v].position[1] += 0.01f * static_cast<float>(v % 300);
  tree.move(scene);
  const TriangleTree fresh(scene);
  EXPECT_TRUE(equal_bytes(tree.nodes(), fresh.nodes()));  // integers in rows may read as NaN
  EXPECT_TRUE(equal_bytes(tree.leaves(), fresh.leaves()));
}

TEST(TriangleTree, OfNothingIsEmpty) {
  const TriangleTree tree{SceneData{}};
  EXPECT_EQ(tree.nodes().size(), std::size_t{CLPV_TREE_NODE_ROWS});
  EXPECT_TRUE(tree.leaves().empty());
}

}  // namespace clpv::near_test
