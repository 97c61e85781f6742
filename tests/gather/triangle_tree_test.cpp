// SPDX-License-Identifier: MIT
// The tree of triangles: its boxes cover each triangle, and it follows moving ones.
// tests/gather/near_test.cpp has rays.
#include "pipeline/gather/triangle_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <utility>

#include "tests/support/scene_builder.hpp"

namespace clpv::triangle_tree_test {
namespace {

using namespace test;

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

}  // namespace
}  // namespace clpv::triangle_tree_test
