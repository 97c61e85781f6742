// SPDX-License-Identifier: MIT
// Closed rooms that are turned against the grid: white furnaces, whose light is known everywhere,
// rooms with a lamp against path tracing, and lines along edges.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

#include "pathtracer/path_tracer.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/view.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"

namespace clpv::turned_rooms_test {
namespace {

using namespace test;

constexpr int kWidth = 120, kHeight = 68;

/// A closed room of 4 m along each edge, turned about an axis through its centre.
struct Room {
  float degrees;
  bool skew = false;   ///< about a skew axis, otherwise about y
  bool sheet = false;  ///< walls of one sheet; otherwise of two, 0.5 m apart
  glm::mat4 turn() const {
    return glm::rotate(glm::mat4(1), glm::radians(degrees),
                       skew ? glm::normalize(glm::vec3(0.4f, 0.8f, -0.45f)) : glm::vec3(0, 1, 0));
  }
  glm::vec3 at(const glm::vec3& p) const { return glm::vec3(turn() * glm::vec4(p, 1)); }
  glm::vec3 along(const glm::vec3& v) const { return glm::vec3(turn() * glm::vec4(v, 0)); }

  SceneData scene(float albedo, float emitted) const {
    SceneData scene;
    const unsigned material = add_material(scene, glm::vec3(albedo));
    for (float& each : scene.materials[material].emissive) each = emitted;
    add_box(scene, glm::vec3(-2), 4, material);
    if (!sheet) {
      const std::size_t inner = scene.triangles.size();
      add_box(scene, glm::vec3(-2.5f), 5, material);
      for (std::size_t t = inner; t < scene.triangles.size(); ++t)
        std::swap(scene.triangles[t].vertex[1], scene.triangles[t].vertex[2]);
      for (std::size_t v = scene.vertices.size() / 2; v < scene.vertices.size(); ++v)
        for (float& n : scene.vertices[v].normal) n = -n;
    }
    for (ClpvVertex& vertex : scene.vertices) {
      const glm::vec3 p = at({vertex.position[0], vertex.position[1], vertex.position[2]}),
                      n = along({vertex.normal[0], vertex.normal[1], vertex.normal[2]});
      for (int axis = 0; axis < 3; ++axis)
        vertex.position[axis] = p[axis], vertex.normal[axis] = n[axis];
    }
    return scene;
  }
  SceneCamera camera() const {
    SceneCamera camera = camera_at({-1.2f, 0.1f, -1}, {2.2f, -0.4f, 2.3f});
    camera.eye = at(camera.eye);
    camera.forward = along(camera.forward), camera.up = along(camera.up);
    return camera;
  }
};

std::vector<float> irradiance(const SceneData& scene, const SceneCamera& camera, Bounces bounces) {
  RenderOptions options;
  options.bounces = bounces, options.width = kWidth, options.height = kHeight;
  Frame frame(test_session(), scene, options);
  frame.render(camera);
  const std::vector<float> pixels = frame.read(Show::irradiance);
  std::vector<float> green;
  for (std::size_t i = 1; i < pixels.size(); i += 4) green.push_back(pixels[i]);
  return green;
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += double{value};
  return sum / static_cast<double>(values.size());
}

/// Share of the pixels in % that are below 0.7 of the median of the 9 x 9 pixels around them.
double lines(const std::vector<float>& image) {
  int dark = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      std::vector<float> around;
      for (int v = std::max(y - 4, 0); v <= std::min(y + 4, kHeight - 1); ++v)
        for (int u = std::max(x - 4, 0); u <= std::min(x + 4, kWidth - 1); ++u)
          around.push_back(image[v * kWidth + u]);
      const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
      std::ranges::nth_element(around, middle);
      dark += image[y * kWidth + x] < 0.7f * *middle ? 1 : 0;
    }
  }
  return 100.0 * dark / (kWidth * kHeight);
}

/// Light of a white furnace over its exact light.
void expect_furnace(const Room& room, float albedo) {
  const SceneData scene = room.scene(albedo, 1);
  for (const Bounces bounces : {Bounces::one, Bounces::all}) {
    const std::vector<float> light = irradiance(scene, room.camera(), bounces);
    const double exact = bounces == Bounces::one ? 1 : 1 / (1 - double{albedo});
    const std::string name =
        fmt::format("albedo {}, {} degrees{}{}, bounces {}", albedo, room.degrees,
                    room.skew ? ", skew" : "", room.sheet ? ", one sheet" : "", name_of(bounces));
    EXPECT_NEAR(mean(light) / std::numbers::pi / exact, 1, albedo > 0.9f ? 0.08 : 0.05) << name;
    EXPECT_LE(lines(light), 0.05) << name;
  }
}

TEST(TurnedRooms, FurnacesHaveTheirLight) {
  expect_furnace({.degrees = 30}, 0.8f);
  expect_furnace({.degrees = 19, .skew = true, .sheet = true}, 0.5f);
}

TEST(LongTurnedRooms, FurnacesHaveTheirLight) {
  for (const float albedo : {0.3f, 0.5f, 0.8f, 0.94f}) {
    for (const float degrees : {0.0f, 7.0f, 19.0f, 30.0f, 45.0f}) {
      for (const bool skew : {false, true}) {
        for (const bool sheet : {false, true}) {
          if (!skew || degrees > 0) expect_furnace({degrees, skew, sheet}, albedo);
        }
      }
    }
  }
}

// A room with a lamp has the light of path tracing, and no lines along its edges.
void expect_lamp_room(const Room& room, Bounces bounces) {
  SceneData scene = room.scene(0.8f, 0);
  scene.lights = {{"lamp", point_light(room.at({0.5f, 0.5f, 0.3f}), glm::vec3(5))}};
  const std::vector<float> light = irradiance(scene, room.camera(), bounces);
  pathtracer::PathTracerOptions options;
  options.noise = 0.04;
  options.bounces = bounces == Bounces::one ? 1 : pathtracer::PathTracerOptions::kAllBounces;
  const Image truth = traced_view(
      trace_paths(scene, scene.lights, camera_view(room.camera(), kWidth, kHeight), options),
      Show::irradiance);
  double sum = 0;
  for (std::size_t i = 1; i < truth.pixels.size(); i += truth.channels.size())
    sum += double{truth.pixels[i]};
  EXPECT_NEAR(mean(light) / (sum / (kWidth * kHeight)), 1, 0.1) << room.degrees;
  EXPECT_LE(lines(light), 0.05) << room.degrees;
}

TEST(TurnedRooms, ALampsRoomHasItsLight) {
  expect_lamp_room({.degrees = 30}, Bounces::one);
}

TEST(LongTurnedRooms, ALampsRoomHasItsLight) {
  for (const float degrees : {0.0f, 10.0f, 30.0f, 45.0f}) {
    for (const bool sheet : {false, true}) {
      expect_lamp_room({.degrees = degrees, .sheet = sheet}, Bounces::one);
      expect_lamp_room({.degrees = degrees, .sheet = sheet}, Bounces::all);
    }
  }
}

}  // namespace
}  // namespace clpv::turned_rooms_test
