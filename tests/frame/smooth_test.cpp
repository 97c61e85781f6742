// SPDX-License-Identifier: MIT
// Smooth meshes: interpolated normals weigh light, triangles decide which side it comes from and
// what shadows them (kernels/shared/normal.h). Direct light against path tracing.
#include <gmock/gmock.h>

#include <numbers>
#include <optional>

#include "kernels/shared/normal.h"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/shade.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/sky.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::smooth_test {
namespace {

using namespace test;
using std::numbers::pi;

constexpr unsigned kWidth = 192, kHeight = 144;  // size of the camera's view
constexpr int kAround = 2;  // pixels around shadow edges and silhouettes that are not compared

SceneData grey_scene() {
  SceneData scene;
  scene.path = "smooth";
  add_grey(scene, 0.7f);
  return scene;
}

/// A quad across z of 3 x 2 m with this normal at all vertices.
SceneData tilted_quad(const glm::vec3& normal) {
  SceneData scene = grey_scene();
  add_quad(scene, {-1.5f, -1, 0}, {3, 0, 0}, {0, 2, 0}, 0);
  for (Vertex& v : scene.vertices)
    for (int c = 0; c < 3; ++c) v.normal[c] = glm::normalize(normal)[c];
  return scene;
}

void add_faces(SceneData& scene, std::initializer_list<std::array<unsigned, 4>> quads) {
  for (const auto& q : quads) {
    scene.triangles.push_back({{q[0], q[1], q[2]}, 0});
    scene.triangles.push_back({{q[0], q[2], q[3]}, 0});
  }
}

/// A cube of 2 m whose corners have one normal each.
SceneData smooth_box() {
  SceneData scene = grey_scene();
  for (unsigned i = 0; i < 8; ++i) {
    const glm::vec3 corner(i / 4 ? 1 : -1, i / 2 % 2 ? 1 : -1, i % 2 ? 1 : -1);
    add_vertex(scene, corner, glm::normalize(corner));
  }
  add_faces(scene,
            {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}});
  return scene;
}

/// A torus of `n` x `m` quads about y.
SceneData torus(unsigned n, unsigned m) {
  SceneData scene = grey_scene();
  for (unsigned i = 0; i < n; ++i) {
    for (unsigned j = 0; j < m; ++j) {
      const double a = 2 * pi * i / n, b = 2 * pi * j / m;
      const glm::vec3 out(std::cos(a), 0, std::sin(a)),
          normal = float(std::cos(b)) * out + glm::vec3(0, std::sin(b), 0);
      add_vertex(scene, out + 0.4f * normal, normal);
    }
  }
  for (unsigned i = 0; i < n; ++i) {
    for (unsigned j = 0; j < m; ++j) {
      const unsigned k = (i + 1) % n * m, l = (j + 1) % m;
      add_faces(scene, {{i * m + j, i * m + l, k + l, k + j}});
    }
  }
  return scene;
}

/// E of the red channel, as a frame computes it with a shadow map of its default size.
std::vector<float> drawn_direct(const SceneData& scene, const ClpvView& view) {
  Session& session = test_session();
  const SceneBuffers buffers = upload_scene(session, scene);
  Rasterizer rasterizer(session, buffers);
  Surface camera = make_surface(session, view, RsmFormat::float32, false);
  rasterizer.rasterize_camera(camera);
  std::vector<ShadowedLight> lights;
  for (const SceneLight& light : scene.lights) {
    ShadowedLight& shadowed = lights.emplace_back(ShadowedLight{light.data, {}, {}, {}});
    shadowed.views = shadow_views(light.data, buffers.bounds, 1024);
    shadowed.view_table = session.upload(shadowed.views, "test: views");
    for (const ClpvView& from : shadowed.views) {
      Buffer& depth = shadowed.depths.emplace_back(
          session.buffer(std::size_t{from.width} * from.height * sizeof(float), "test: map"));
      rasterizer.rasterize_shadow(from, depth);
    }
  }
  Shader shader(session);
  shader.light(camera, lights);
  const std::size_t pixels = std::size_t{view.width} * view.height;
  Buffer gathered = session.buffer(pixels * sizeof(cl_float4), "test: irradiance"),
         image = session.buffer(pixels * sizeof(cl_float4), "test: image");
  session.fill_zero(gathered, pixels * sizeof(cl_float4));
  shader.show(Show::direct, camera, gathered, image);
  std::vector<float> e;
  for (const cl_float4& pixel : session.read<cl_float4>(image, pixels))
    e.push_back(pixel.s[0] * std::numbers::pi_v<float> / 0.7f);
  return e;
}

struct Errors {
  double nrmse = 0, energy = 0;
  std::size_t pixels = 0;
};

/// Errors away from silhouettes and shadow edges: of pixels around which all show a surface that is
/// lit, or all one that is dark.
Errors errors_of_direct(SceneData scene) {
  scene.lights = {sun({0.4f, -1, -0.3f}, 10)};
  const ClpvView view =
      view_of({2.2f, 2.4f, 3.2f}, {-2.2f, -2.5f, -3.2f}, {0, 1, 0}, 0.6f, kWidth, kHeight);
  PathTracerOptions options;
  options.samples = 1;
  const TracedImage truth = trace_paths(scene, view, options);
  const std::vector<float> found = drawn_direct(scene, view);
  double squares = 0, signal = 0, sum = 0, expected = 0;
  Errors errors;
  for (int y = kAround; y < int(kHeight) - kAround; ++y) {
    for (int x = kAround; x < int(kWidth) - kAround; ++x) {
      const std::size_t at = std::size_t{kWidth} * y + x;
      bool alike = true;
      for (int dy = -kAround; dy <= kAround; ++dy) {
        for (int dx = -kAround; dx <= kAround; ++dx) {
          const std::size_t other = at + dy * int(kWidth) + dx;
          alike = alike && truth.depth[other] > 0 &&
                  (truth.direct[other].x > 0) == (truth.direct[at].x > 0);
        }
      }
      if (!alike) continue;
      const double e = found[at], wanted = truth.direct[at].x;
      squares += (e - wanted) * (e - wanted), signal += wanted * wanted;
      sum += e, expected += wanted;
      ++errors.pixels;
    }
  }
  errors.nrmse = std::sqrt(squares / signal), errors.energy = sum / expected;
  return errors;
}

TEST(Smooth, DirectLightIsThatOfPathTracing) {
  const std::pair<const char*, SceneData> scenes[] = {
      {"quad (0, .5, 1)", tilted_quad({0, 0.5f, 1})},
      {"quad (-.6, -.2, 1)", tilted_quad({-0.6f, -0.2f, 1})},
      {"box", smooth_box()},
      {"torus", torus(16, 8)}};
  for (auto [name, scene] : scenes) {
    SCOPED_TRACE(name);
    if (scene.vertices.size() > 4)  // a floor for their shadows
      add_quad(scene, {-6, -1.2f, -6}, {0, 0, 12}, {12, 0, 0}, 0);
    const Errors errors = errors_of_direct(scene);
    EXPECT_GT(errors.pixels, 1000u);
    EXPECT_LT(errors.nrmse, 0.01);
    EXPECT_NEAR(errors.energy, 1, 0.01);
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
