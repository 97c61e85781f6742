// SPDX-License-Identifier: MIT
// The hall: boxes for floor, walls and columns, with a camera and a sun.
#include "bench/hall.hpp"

#include <algorithm>
#include <cmath>

namespace clpv::bench {
namespace {

constexpr int kColumns = 6, kBoxes = 5 + kColumns, kFaces = 6;

/// Adds one side of a box: the parallelogram corner, corner + u, corner + v, as divisions^2 pairs
/// of triangles.
void add_side(SceneData& scene, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v,
              int divisions, unsigned material) {
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  const auto first = static_cast<unsigned>(scene.vertices.size());
  const auto row = static_cast<unsigned>(divisions + 1);
  for (int j = 0; j <= divisions; ++j) {
    for (int i = 0; i <= divisions; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(divisions),
                  t = static_cast<float>(j) / static_cast<float>(divisions);
      const glm::vec3 p = corner + s * u + t * v;
      scene.vertices.push_back(
          {{p.x, p.y, p.z}, {normal.x, normal.y, normal.z}, {s, t}, {1.0f, 1.0f, 1.0f, 1.0f}});
    }
  }
  for (unsigned j = 0; j + 1 < row; ++j) {
    for (unsigned i = 0; i + 1 < row; ++i) {
      const unsigned a = first + j * row + i, b = a + 1, c = a + row, d = c + 1;
      scene.triangles.push_back({{a, b, d}, material});
      scene.triangles.push_back({{a, d, c}, material});
    }
  }
}

void add_box(SceneData& scene, const glm::vec3& lower, const glm::vec3& upper, int divisions,
             const glm::vec3& albedo) {
  const auto material = static_cast<unsigned>(scene.materials.size());
  scene.materials.push_back(
      {{albedo.x, albedo.y, albedo.z, 1.0f}, {0, 0, 0}, 0, CLPV_NO_TEXTURE, CLPV_NO_TEXTURE, 0, 0});
  const glm::vec3 size = upper - lower;
  const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  add_side(scene, lower, y, x, divisions, material);      // towards -z
  add_side(scene, lower + z, x, y, divisions, material);  // +z
  add_side(scene, lower, z, y, divisions, material);      // -x
  add_side(scene, lower + x, y, z, divisions, material);  // +x
  add_side(scene, lower, x, z, divisions, material);      // -y
  add_side(scene, lower + y, z, x, divisions, material);  // +y
}

}  // namespace

SceneData make_hall(int triangles) {
  const int divisions =
      std::max(1, static_cast<int>(std::lround(std::sqrt(triangles / (2.0 * kFaces * kBoxes)))));
  SceneData scene;
  scene.name = "hall";
  constexpr float kHalf = 12, kThick = 0.5f, kHeight = 10;
  const glm::vec3 stone(0.7f, 0.65f, 0.6f);
  add_box(scene, {-kHalf, -kThick, -kHalf}, {kHalf, 0, kHalf}, divisions, stone);
  add_box(scene, {-kHalf, 0, -kHalf}, {-kHalf + kThick, kHeight, kHalf}, divisions,
          {0.7f, 0.2f, 0.15f});
  add_box(scene, {kHalf - kThick, 0, -kHalf}, {kHalf, kHeight, kHalf}, divisions,
          {0.2f, 0.5f, 0.2f});
  add_box(scene, {-kHalf, 0, -kHalf}, {kHalf, kHeight, -kHalf + kThick}, divisions, stone);
  add_box(scene, {-kHalf, 0, kHalf - kThick}, {kHalf, kHeight, kHalf}, divisions, stone);
  for (int i = 0; i < kColumns; ++i) {
    const glm::vec3 foot(i % 2 == 0 ? -5 : 5, 0, -6 + 5 * (i / 2));
    add_box(scene, foot - glm::vec3(0.6f, 0, 0.6f), foot + glm::vec3(0.6f, 7, 0.6f), divisions,
            stone);
  }
  scene.lower = {-kHalf, -kThick, -kHalf};
  scene.upper = {kHalf, kHeight, kHalf};
  SceneCamera camera;
  camera.name = "hall";
  camera.eye = {0.3f, 2.2f, 9};
  camera.forward = glm::normalize(glm::vec3(-0.05f, -0.1f, -1));
  const glm::vec3 right = glm::normalize(glm::cross(camera.forward, glm::vec3(0, 1, 0)));
  camera.up = glm::cross(right, camera.forward);
  scene.cameras.push_back(camera);
  SceneLight sun{"sun", {}};
  const glm::vec3 down = glm::normalize(glm::vec3(0.45f, -1, 0.2f));
  for (int a = 0; a < 3; ++a) {
    sun.data.direction[a] = down[a];
    sun.data.intensity[a] = a == 2 ? 9 : 10;
  }
  sun.data.kind = CLPV_LIGHT_DIRECTIONAL;
  scene.lights.push_back(sun);
  return scene;
}

}  // namespace clpv::bench
