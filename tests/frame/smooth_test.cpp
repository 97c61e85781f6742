// SPDX-License-Identifier: MIT
// Smooth meshes: interpolated normals weigh light, triangles decide which side it comes from and
// what shadows them (kernels/shared/normal.h).
#include <gtest/gtest.h>

#include <numbers>

#include "kernels/shared/normal.h"
#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/sky.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::smooth_test {
namespace {

using namespace test;
using std::numbers::pi;

/// A quad across z of 3 x 2 m with this normal at all vertices.
SceneData tilted_quad(const glm::vec3& normal) {
  SceneData scene;
  scene.path = "smooth";
  scene.lower = {-1.5f, -1, -0.1f}, scene.upper = {1.5f, 1, 0.1f};
  add_grey(scene, 0.7f);
  add_quad(scene, {-1.5f, -1, 0}, {3, 0, 0}, {0, 2, 0}, 0);
  for (Vertex& v : scene.vertices)
    for (int c = 0; c < 3; ++c) v.normal[c] = glm::normalize(normal)[c];
  return scene;
}

TEST(Smooth, DirectLightIsWeighedByTheNormalOnTheTrianglesSide) {
  const glm::vec3 normal = glm::normalize(glm::vec3(-0.6f, 0.5f, 1));
  SceneData scene = tilted_quad(normal);
  RenderOptions options;
  options.width = options.height = 8, options.cascades = 1, options.cascade_size = 4;
  options.rsm_size = 16;
  const glm::vec3 before_both(0.2f, -0.5f, -1), behind_the_triangle(1, -1, 0.1f),
      behind_the_normal(-1, 1, -0.1f);
  for (const glm::vec3& direction : {before_both, behind_the_triangle, behind_the_normal}) {
    scene.lights = {sun(direction, 10)};
    Frame frame(test_session(), scene, options);
    frame.render(camera_at({0, 0, 1}, {0, 0, -1}));
    const double cosine =
                     direction == before_both ? -glm::dot(normal, glm::normalize(direction)) : 0,
                 expected = 0.7 / pi * 10 * cosine;
    EXPECT_NEAR(mean(frame.read(Show::direct), 0), expected, 1e-3) << direction.z;
  }
}

TEST(Smooth, AVirtualPointLightLiesOnItsTriangleWithTheLightThatItsNormalWeighs) {
  SceneData scene = tilted_quad({0, 0.5f, 1});
  const SceneLight light = sun({0.2f, -1, -1}, 10);
  const ClpvGrid cascade{{-4, -4, -4}, 0.25f, 32, {}};
  Session& session = test_session();
  const SceneBuffers buffers = upload_scene(session, scene);
  Rasterizer rasterizer(session, buffers);
  Surface rsm =
      make_surface(session, directional_rsm_view(light.data, cascade, buffers.bounds, 256),
                   RsmFormat::float32, false);
  rasterizer.rasterize_rsm(light.data, rsm);
  const SurfaceImage image = read_surface(session, rsm);
  const glm::dvec3 towards = -glm::normalize(glm::dvec3(0.2, -1, -1));
  const double weight = glm::dot(glm::normalize(glm::dvec3(0, 0.5, 1)), towards) / towards.z;
  const double texel = 4.0 * rsm.view.half_width * rsm.view.half_height / (256 * 256);  // [m^2]
  std::size_t texels = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (image.depth[i] <= 0) continue;
    ++texels;
    ASSERT_NEAR(image.normal[i].z, 1, 1e-6);
    ASSERT_NEAR(image.colour[i].x, 0.7 * 10 * texel * weight, 1e-3 * texel);
  }
  EXPECT_GT(texels, 500u);
}

TEST(Smooth, PathTracingLightsByTheTriangleAndWeighsByTheNormal) {
  const glm::vec3 normal = glm::normalize(glm::vec3(0, 2, 1));  // 63 degrees off the triangle's
  SceneData scene = tilted_quad(normal);
  const ClpvView view = view_of({0, 0, 2}, {0, 0, -1}, {0, 1, 0}, 0.2f, 8, 8);
  PathTracerOptions options;
  options.samples = 256;
  scene.sky = std::make_shared<Sky>(constant_sky(glm::vec3(1)));
  // The integral of the clamped cosine over the half of directions above the triangle.
  const double expected = pi * (1 + double{normal.z}) / 2;
  for (const glm::vec3& e : trace_paths(scene, view, options).irradiance)
    ASSERT_NEAR(e.x, expected, 0.05 * expected);
  scene.sky = nullptr;
  options.samples = 1;
  scene.lights = {sun({0, -1, 0.1f}, 1)};  // on the normal's side, behind the triangle
  for (const glm::vec3& e : trace_paths(scene, view, options).direct) ASSERT_EQ(e.x, 0);
  scene.lights = {sun({0, 0.9f, -1}, 1)};  // before the triangle, behind the normal
  for (const glm::vec3& e : trace_paths(scene, view, options).direct) ASSERT_EQ(e.x, 0);
}

TEST(Smooth, GeometricNormalsKeepTheirDirection) {
  for (int i = 0; i < 1000; ++i) {
    const double z = (i + 0.5) / 500 - 1, a = 2.4 * i, r = std::sqrt(1 - z * z);
    const glm::dvec3 n(r * std::cos(a), r * std::sin(a), z);
    const glm::vec4 stored = stored_normal(-n, n);
    ASSERT_LT(glm::length(geometric_normal(stored) - n), 1e-3) << i;
    ASSERT_EQ(stored_normal(n, n).w, 0) << "one normal";
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      glm::dvec3 n(0);
      n[axis] = sign;
      EXPECT_EQ(geometric_normal(stored_normal(glm::normalize(glm::dvec3(1, 2, 3)), n)), n);
    }
  }
}

}  // namespace
}  // namespace clpv::smooth_test
