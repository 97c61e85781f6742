// SPDX-License-Identifier: MIT
// Ray casting: holes, single-sided surfaces, and the same image as the rasteriser's.
#include "pathtracer/ray_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipeline/raster/view.hpp"
#include "tests/support/drawn.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::ray_scene_test {
namespace {

using namespace test;

/// 2 x 2 texels: opaque red, a hole; a hole, opaque green at sRGB 188 (linear 0.503).
Texture checker() {
  Texture texture;
  texture.width = texture.height = 2;
  texture.rgba = {255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 188, 0, 255};
  return texture;
}

TEST(RayScene, MaskedHolesAreTransparent) {
  SceneData scene = floor_scene(0.5);
  scene.textures = {checker()};
  ClpvMaterial& masked = scene.materials[add_material(
      scene, glm::vec3(1), CLPV_MATERIAL_MASKED | CLPV_MATERIAL_DOUBLE_SIDED)];
  masked.texture = 0;
  masked.alpha_cutoff = 0.5f;
  add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, 1);  // u along x, v along z, facing down
  scene.lights = {sun({0, -1, 0}, 1)};
  PathTracerOptions options;
  options.samples = 1;
  // The four quarters of the grid, each at its texel's centre; then the floor below them, from
  // beside.
  const ClpvView view = view_of({0, 3, 0}, {0, -1, 0}, {0, 0, -1}, 0.5f, 2, 2);
  const TracedImage image = trace_paths(scene, view, options);
  EXPECT_NEAR(image.depth[0], 2, 1e-5);  // u = v = 1/4: red
  EXPECT_NEAR(image.depth[1], 3, 1e-5);  // u = 3/4, v = 1/4: hole
  EXPECT_NEAR(image.depth[2], 3, 1e-5);
  EXPECT_NEAR(image.depth[3], 2, 1e-5);
  EXPECT_NEAR(glm::length(image.albedo[0] - glm::vec3(1, 0, 0)), 0, 1e-6);
  EXPECT_NEAR(image.albedo[3].y, 0.5029, 1e-3) << "sRGB is decoded";
  EXPECT_GT(image.normal[0].y, 0.99) << "turned towards the viewer";
  EXPECT_NEAR(image.direct[1].x, 1, 1e-6) << "sun through the hole";

  const ClpvView below = view_of({0, 0.9f, 0}, {0, -1, 0}, {0, 0, -1}, 1 / 1.8f, 2, 2);
  const TracedImage floor = trace_paths(scene, below, options);
  EXPECT_EQ(floor.direct[0].x, 0) << "in the shadow of the red texel";
  EXPECT_NEAR(floor.direct[1].x, 1, 1e-6);
}

TEST(RayScene, SingleSidedSurfacesAreSeenFromTheirFrontAndShadeFromBoth) {
  SceneData scene = floor_scene(0.5);
  scene.lights = {sun({0, -1, 0}, 1)};
  add_grey(scene, 1);
  add_quad(scene, {-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, 1);  // faces down: unseen from above
  PathTracerOptions options;
  options.samples = 1;
  const TracedImage image = trace_paths(scene, kDown, options);
  const std::size_t centre = 3 * kDown.width + 4;
  EXPECT_NEAR(image.depth[centre], 2, 1e-5);
  EXPECT_EQ(image.direct[centre].x, 0);
  EXPECT_NEAR(image.direct[0].x, 1, 1e-6);
}

// glTF: alpha of the cutoff and above is opaque. Factor, vertices or texels have one alpha.
TEST(RayScene, AlphaOfTheCutoffIsOpaque) {
  struct Case {
    float factor, vertex;
    int texel;  // texel of the texture's alpha; -1: no texture
    float cutoff;
  };
  std::vector<Case> cases = {{0.3f, 1, -1, 0.3f},
                             {0.9f, 1, -1, 0.9f},
                             {1, 0.3f, -1, 0.3f},
                             {1, 0.7f, -1, 0.7f},
                             {1, 1, -1, 1}};
  for (const int texel : {1, 77, 128, 201, 254})
    cases.push_back({1, 1, texel, static_cast<float>(texel) / 255.0f});
  // Not a whole number of pixels: weights of all sizes.
  const ClpvView view = view_of({0.1f, 3, 0.03f}, {0.05f, -1, 0.02f}, {0, 0, -1}, 0.3f, 61, 59);
  PathTracerOptions options;
  options.samples = 1;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.cutoff);
    SceneData scene = floor_scene(0.5);
    ClpvMaterial& masked = scene.materials[add_material(
        scene, glm::vec3(1), CLPV_MATERIAL_MASKED | CLPV_MATERIAL_DOUBLE_SIDED)];
    masked.base_colour[3] = c.factor, masked.alpha_cutoff = c.cutoff;
    if (c.texel >= 0) {
      Texture texture = checker();
      for (std::size_t i = 3; i < texture.rgba.size(); i += 4)
        texture.rgba[i] = static_cast<std::uint8_t>(c.texel);
      scene.textures = {texture};
      masked.texture = 0;
    }
    add_quad(scene, {-2, 1, -2}, {0, 0, 4}, {4, 0, 0}, 1);
    for (std::size_t i = 4; i < 8; ++i) scene.vertices[i].colour[3] = c.vertex;
    scene.lights = {sun({0, -1, 0}, 1)};
    const SurfaceImage drawn = test::drawn(scene, view);
    const TracedImage traced = trace_paths(scene, view, options);
    for (std::size_t i = 0; i < traced.depth.size(); ++i) {
      ASSERT_LT(drawn.depth[i], 2.1) << "the floor shows in pixel " << i;
      ASSERT_LT(traced.depth[i], 2.1) << "the floor shows in pixel " << i;
    }
  }
}

/// Random triangles with bent normals and random textures: plain, with holes, seen from both sides
/// or one.
SceneData clutter() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-1, 1);
  SceneData scene;
  scene.path = "clutter";
  Texture texture;
  texture.width = 64, texture.height = 32;
  texture.wrap_v = CLPV_WRAP_MIRROR;
  for (unsigned i = 0; i < 4 * 64 * 32; ++i)
    texture.rgba.push_back(static_cast<std::uint8_t>(random()));
  scene.textures = {texture};
  for (const unsigned flags :
       {0u, CLPV_MATERIAL_MASKED | CLPV_MATERIAL_DOUBLE_SIDED, CLPV_MATERIAL_DOUBLE_SIDED}) {
    ClpvMaterial& material = scene.materials[add_material(scene, {0.9f, 0.8f, 0.7f}, flags)];
    material.texture = 0;
    material.alpha_cutoff = 0.5f;
  }
  for (unsigned t = 0; t < 90; ++t) {
    const glm::vec3 centre(6 * any(random), 4 * any(random), -8 + 5 * any(random));
    add_triangle(scene, centre + glm::vec3(any(random), 2, any(random)),
                 centre + glm::vec3(-2, any(random), any(random)),
                 centre + glm::vec3(2, any(random), any(random)), t % 3);
    for (unsigned i = 0; i < 3; ++i) {
      Vertex& v = scene.vertices[3 * t + i];
      const glm::vec3 bent =
          glm::normalize(glm::vec3(v.normal[0], v.normal[1], v.normal[2]) + 0.3f * any(random));
      for (int c = 0; c < 3; ++c) v.normal[c] = bent[c];
      v.uv[0] = 3 * any(random), v.uv[1] = 2 * any(random);
    }
  }
  scene.lights = {sun({0, -1, -1}, 1)};
  return scene;
}

// Pixel by pixel, or else every comparison would measure two different pictures.
TEST(RayScene, SeesWhatTheRasteriserSees) {
  const SceneData scene = clutter();
  const ClpvView view = camera_view(SceneCamera{}, 160, 90);
  PathTracerOptions options;
  options.samples = 1;
  const TracedImage traced = trace_paths(scene, view, options);
  const SurfaceImage drawn = test::drawn(scene, view);
  std::size_t seen = 0, elsewhere = 0, differ = 0;
  for (std::size_t i = 0; i < traced.depth.size(); ++i) {
    if (traced.depth[i] == 0 && drawn.depth[i] == 0) continue;
    ++seen;
    if (std::abs(traced.depth[i] - drawn.depth[i]) > 1e-4f * drawn.depth[i]) {
      ++elsewhere;  // an edge or a hole's rim, which runs within a hair of the pixel's centre
      continue;
    }
    const float normal = glm::length(traced.normal[i] - glm::vec3(drawn.normal[i]));
    const float albedo = glm::length(traced.albedo[i] - glm::vec3(drawn.colour[i]));
    if (normal > 1e-3f || albedo > 1e-3f) ++differ;
  }
  EXPECT_GT(seen, 8000u);
  EXPECT_LT(elsewhere, seen / 200);
  EXPECT_LT(differ, seen / 200);
}

}  // namespace
}  // namespace clpv::ray_scene_test
