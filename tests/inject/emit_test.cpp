// SPDX-License-Identifier: MIT
// Emissive surfaces: flux and positions of their virtual point lights, and the light in a frame.
#include "pipeline/inject/emit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/inject/inject.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/inject.hpp"
#include "support/error.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/traced_scenes.hpp"
#include "verify/check.hpp"

namespace clpv::emit_test {
using namespace test;
using std::numbers::pi;

unsigned add_lamp_material(SceneData& scene, const glm::vec3& radiance, unsigned flags = 0) {
  const unsigned material = add_material(scene, glm::vec3(0), flags);
  for (int i = 0; i < 3; ++i) scene.materials[material].emissive[i] = radiance[i];
  return material;
}

std::vector<ClpvGrid> grids_about(const glm::vec3& eye, int count = 2) {
  return cascade_grids(eye, count, 4, 8);
}

/// Points by the kernel, as injection gets them.
SurfaceImage emitted(const SceneData& scene, const EmissionPlan& plan, float scale = 1) {
  const SceneBuffers buffers = upload_scene(test_session(), scene);
  Emitter emitter(test_session(), buffers);
  emitter.emit(plan, scale);
  return read_surface(test_session(), emitter.points());
}

EmissionPlan plan_of(const SceneData& scene, const std::vector<ClpvGrid>& grids) {
  return plan_emission(scene, emissive_triangles(scene), grids);
}

glm::dvec3 total(const SurfaceImage& points) {
  glm::dvec3 sum(0);
  for (const glm::vec4& flux : points.colour) sum += glm::dvec3(flux);
  return sum;
}

TEST(Emit, FluxIsPiTimesRadianceTimesArea) {
  for (const unsigned sides : {1u, 2u}) {
    SceneData scene;
    const unsigned flags = sides == 2 ? CLPV_MATERIAL_DOUBLE_SIDED : 0;
    add_quad(scene, {-0.6f, 0.3f, 0.1f}, {0.7f, 0.2f, 0}, {0, 0.3f, 0.5f},
             add_lamp_material(scene, {5, 1, 0.25f}, flags));
    const double area =
        glm::length(glm::cross(glm::dvec3(0.7f, 0.2f, 0), glm::dvec3(0, 0.3f, 0.5f)));
    const glm::dvec3 flux = total(emitted(scene, plan_of(scene, grids_about({0, 0, 0})), 2));
    EXPECT_NEAR(flux.x, sides * 2 * pi * 5 * area, 1e-4 * flux.x);
    EXPECT_NEAR(flux.y, sides * 2 * pi * 1 * area, 1e-4 * flux.y);
    EXPECT_NEAR(flux.z, sides * 2 * pi * 0.25 * area, 1e-4 * flux.z);
  }
}

// A spot of a few texels on a texture much finer than the point spacing is neither missed nor
// counted twice.
TEST(Emit, ASmallBrightSpotCountsOnceAnywhere) {
  for (const unsigned at : {3u, 517u, 1020u}) {
    SceneData scene;
    Texture spot{.width = 1024, .height = 1024, .rgba = {}, .name = "spot"};
    spot.wrap_u = spot.wrap_v = CLPV_WRAP_CLAMP;
    spot.rgba.assign(4u * 1024 * 1024, 0);
    for (unsigned y = 300; y < 304; ++y) {
      for (unsigned x = at; x < at + 4; ++x) spot.rgba[4 * (y * 1024 + x)] = 255;
    }
    scene.textures.push_back(spot);
    const unsigned material = add_lamp_material(scene, glm::vec3(1e4f));
    scene.materials[material].emissive_texture = 0;
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, material);
    const SurfaceImage points = emitted(scene, plan_of(scene, grids_about({0, 0, 0})));
    const double wanted = pi * 1e4 * 4 * 16 / (1024.0 * 1024);
    EXPECT_NEAR(total(points).x, wanted, 0.05 * wanted) << at;
    // The light comes from the spot: v runs along x, u along z.
    for (std::size_t i = 0; i < points.colour.size(); ++i) {
      if (points.colour[i].x < 0.1 * wanted) continue;
      EXPECT_NEAR(points.position[i].x, -1 + 2 * 302.0 / 1024, 0.15) << at;
      EXPECT_NEAR(points.position[i].z, -1 + 2 * (at + 2.0) / 1024, 0.15) << at;
    }
  }
}

TEST(Emit, HolesDoNotEmit) {
  SceneData scene;
  scene.textures.push_back({.width = 2,
                            .height = 1,
                            .wrap_u = CLPV_WRAP_CLAMP,
                            .rgba = {255, 255, 255, 255, 255, 255, 255, 0},
                            .name = "half a hole"});
  const unsigned material = add_lamp_material(scene, glm::vec3(2), CLPV_MATERIAL_MASKED);
  scene.materials[material].texture = 0, scene.materials[material].alpha_cutoff = 0.5f;
  add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, material);
  const double flux = total(emitted(scene, plan_of(scene, grids_about({0, 0, 0})))).x;
  EXPECT_NEAR(flux, pi * 2 * 4 / 2, 0.02 * flux);
}

// A surface that reaches through all cascades: points are dense near the eye, sparse far off,
// nowhere twice, none outside.
TEST(Emit, PointsAreAsFarApartAsTheCellsThere) {
  SceneData scene;
  add_quad(scene, {-100, 0, -100}, {0, 0, 200}, {200, 0, 0},
           add_lamp_material(scene, glm::vec3(1)));
  const std::vector<ClpvGrid> grids = grids_about({0.3f, 0.2f, -0.4f}, 3);
  const EmissionPlan plan = plan_of(scene, grids);
  EXPECT_EQ(plan.coarsened, 0);
  std::vector<double> areas(grids.size(), 0);
  for (const reference::EmittedPoint& point : reference::emit(scene, plan)) {
    for (std::size_t c = 0; c < grids.size(); ++c) {
      const ClpvGrid& grid = grids[c];
      const glm::dvec3 within =
          (point.position - glm::dvec3(grid.origin[0], grid.origin[1], grid.origin[2])) /
          double{grid.cell};
      if (std::min({within.x, within.y, within.z}) < 0 ||
          std::max({within.x, within.y, within.z}) > grid.n)
        continue;
      areas[c] += point.flux.x / pi;
      if (c > 0) continue;
      const double apart = std::sqrt(point.flux.x / pi / (double{grid.cell} * grid.cell));
      EXPECT_LE(apart, 1.0 / kEmittedPointsPerCell);
    }
  }
  for (std::size_t c = 0; c < grids.size(); ++c) {
    const double edge = grids[c].n * double{grids[c].cell};
    EXPECT_NEAR(areas[c], edge * edge, 0.02 * edge * edge) << c;
  }
  EXPECT_LT(plan.points, 60'000u);
}

TEST(Emit, TheNumberOfPointsIsBounded) {
  SceneData scene;
  const unsigned lamp = add_lamp_material(scene, glm::vec3(1));
  add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, lamp);
  const std::vector<ClpvGrid> grids = grids_about({0, 0, 0});
  const std::vector<std::uint32_t> triangles = emissive_triangles(scene);
  const EmissionPlan all = plan_emission(scene, triangles, grids);
  const EmissionPlan few = plan_emission(scene, triangles, grids, all.points - 1);
  EXPECT_EQ(few.coarsened, 1);
  EXPECT_LT(few.points, all.points);
  EXPECT_NEAR(total(emitted(scene, few)).x, total(emitted(scene, all)).x, 1e-3);
  EXPECT_THROW(plan_emission(scene, triangles, grids, 1), Error);
  for (int i = 0; i < 50; ++i)
    add_triangle(scene, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, lamp);  // no area
  EXPECT_EQ(plan_of(scene, grids).points, all.points);
}

TEST(Emit, MaximumFluxIsThatOfACellOrTheTotal) {
  SceneData scene;
  add_quad(scene, {0, 0, 0}, {0, 0, 1}, {2, 0, 0}, add_lamp_material(scene, {3, 1, 1}));
  const std::vector<std::uint32_t> triangles = emissive_triangles(scene);
  EXPECT_NEAR(max_emitted_flux(scene, triangles, 0.5), pi * 3 * 0.25, 1e-6);
  EXPECT_NEAR(max_emitted_flux(scene, triangles, 100), pi * 3 * 2, 1e-6);
  EXPECT_FALSE(emits(floor_scene(0.5)));
  EXPECT_TRUE(emits(scene));
}

/// A small lamp over a visible floor, without a ceiling.
SceneData lamp_over_floor(float edge = 0.5f) {
  SceneData scene = floor_scene(0.5f);
  add_quad(scene, {-edge / 2, 1.5f, -edge / 2}, {edge, 0, 0}, {0, 0, edge},
           add_lamp_material(scene, {8, 4, 2}));
  scene.cameras.push_back({});
  scene.cameras[0].eye = {0, 1.2f, 0}, scene.cameras[0].forward = {0, -1, 0},
  scene.cameras[0].up = {0, 0, -1};
  scene.lower = {-10, 0, -10}, scene.upper = {10, 1.5f, 10};
  return scene;
}

RenderOptions small_frame() {
  RenderOptions options;
  options.width = 24, options.height = 24, options.cascades = 2, options.cascade_size = 4;
  options.rsm_size = 16, options.shadow_size = 16;
  return options;
}

// A square over a parallel plane: the mean of the visible E against path tracing, which
// path_tracer_test.cpp compares with closed forms.
TEST(EmissiveFrame, LightsAFloorAsPathTracingDoes) {
  const SceneData scene = lamp_over_floor();
  Frame frame(test_session(), scene, small_frame());
  frame.render(scene.cameras[0]);
  const std::vector<float> found = frame.read(Show::irradiance);
  PathTracerOptions options;
  options.samples = 256;
  const TracedImage truth =
      pathtracer::trace_paths(scene, {}, camera_view(scene.cameras[0], 24, 24), options);
  double wanted = 0;
  for (const glm::vec3& e : truth.irradiance) wanted += e.x / truth.irradiance.size();
  EXPECT_NEAR(mean(found, 0), wanted, 0.15 * wanted)
      << "few directions lead from a small lamp to a far floor";
  EXPECT_NEAR(mean(found, 1), mean(found, 0) / 2, 1e-3 * wanted);
  EXPECT_NEAR(mean(found, 2), mean(found, 0) / 4, 1e-3 * wanted);
}

}  // namespace clpv::emit_test
