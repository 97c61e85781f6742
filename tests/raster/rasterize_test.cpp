// SPDX-License-Identifier: MIT
// The rasteriser against closed forms: coverage, depth, normals, flux, clipping, culling, holes,
// repeatability.
#include "pipeline/raster/rasterize.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <climits>
#include <cmath>
#include <functional>
#include <random>

#include "kernels/shared/loops.h"
#include "kernels/shared/region.h"
#include "pipeline/raster/view.hpp"
#include "support/error.hpp"
#include "tests/support/drawn.hpp"
#include "tests/support/scene_builder.hpp"

namespace clpv::rasterize_test {
using test::add_material;
using test::add_quad;
using test::camera_at;
using test::directional_light;
using test::drawn;
using test::test_session;

ClpvView small_camera(int width = 48, int height = 32) {
  return camera_view(camera_at({0, 0, 0}, {0, 0, -1}), width, height);
}

SurfaceImage rsm_image(const SceneData& scene, const ClpvLight& light, const ClpvView& view,
                       RsmFormat format = RsmFormat::float32) {
  Session& session = test_session();
  Rasterizer rasterizer(session, upload_scene(session, scene));
  Surface surface = make_surface(session, view, format, false);
  rasterizer.rasterize_rsm(light, surface);
  return read_surface(session, surface);
}

std::vector<float> shadow_depth(const SceneData& scene, const ClpvView& view) {
  Session& session = test_session();
  Rasterizer rasterizer(session, upload_scene(session, scene));
  const std::size_t count = static_cast<std::size_t>(view.width) * view.height;
  Buffer depth = session.buffer(count * sizeof(float), "depth");
  rasterizer.rasterize_shadow(view, depth);
  return session.read<float>(depth, count);
}

std::size_t covered(const std::vector<float>& depth) {
  return static_cast<std::size_t>(
      std::count_if(depth.begin(), depth.end(), [](float d) { return d != 0; }));
}

/// A wall 4 m before the camera, larger than its view.
SceneData wall(float distance = 4) {
  SceneData scene;
  add_quad(scene, {-20, -20, -distance}, {40, 0, 0}, {0, 40, 0},
           add_material(scene, {0.25f, 0.5f, 0.75f}));
  return scene;
}

TEST(Rasterize, LightSeesBothSides) {
  for (const float side : {1.0f, -1.0f}) {
    SceneData scene;
    add_quad(scene, {-10, 0, -10 * side}, {20, 0, 0}, {0, 0, 20 * side}, add_material(scene));
    const ClpvLight light = directional_light({0.2f, -1, 0.1f});
    const ClpvView view =
        directional_rsm_view(light, {{-2, -2, -2}, 0.5f, 8, {}}, {{-10, -1, -10}, {10, 5, 10}}, 16);
    const SurfaceImage image = rsm_image(scene, light, view);
    EXPECT_EQ(covered(image.depth), image.depth.size());
    for (const glm::vec4& normal : image.normal) EXPECT_EQ(glm::vec3(normal), glm::vec3(0, 1, 0));
  }
}

/// How often each pixel of `view` is covered by the triangles of `scene`, drawn one at a time.
std::vector<int> coverage(const SceneData& scene, const ClpvView& view) {
  std::vector<int> count(static_cast<std::size_t>(view.width) * view.height, 0);
  SceneData one = scene;
  for (const Triangle& triangle : scene.triangles) {
    one.triangles = {triangle};
    const std::vector<float> depth = shadow_depth(one, view);
    for (std::size_t i = 0; i < depth.size(); ++i) count[i] += depth[i] != 0 ? 1 : 0;
  }
  return count;
}

/// A plane of cells x cells quads with moved corners, two triangles each, that reaches beyond the
/// view. `step`: corners move in multiples of it, as a part of a quad's edge; 0: anywhere.
SceneData jittered_plane(int cells, float extent, float depth, float step) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(-0.3f, 0.3f);
  SceneData scene;
  const unsigned material = add_material(scene);
  const float edge = 2 * extent / static_cast<float>(cells);
  const auto jitter = [&] {
    const float by = uniform(random);
    return edge * (step > 0 ? step * std::round(by / step) : by);
  };
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const glm::vec3 p(-extent + edge * static_cast<float>(i) + jitter(),
                        -extent + edge * static_cast<float>(j) + jitter(),
                        -depth + 0.3f * uniform(random));
      test::add_vertex(scene, p, {0, 0, 1});
    }
  }
  const auto row = static_cast<unsigned>(cells + 1);
  for (unsigned j = 0; j + 1 < row; ++j) {
    for (unsigned i = 0; i + 1 < row; ++i) {
      const unsigned a = j * row + i;
      scene.triangles.push_back({{a, a + 1, a + row + 1}, material});
      scene.triangles.push_back({{a, a + row + 1, a + row}, material});
    }
  }
  return scene;
}

ClpvView orthographic_square(float half, int size, float near_depth = 0.1f, float far_depth = 100) {
  ClpvView view = small_camera(size, size);
  view.orthographic = 1;
  view.half_width = view.half_height = half;
  view.near_depth = near_depth;
  view.far_depth = far_depth;
  return view;
}

TEST(Rasterize, SharedEdgesLeaveNoHoleAndDrawNothingTwice) {
  const SceneData anywhere = jittered_plane(7, 5, 4, 0);
  EXPECT_THAT(coverage(anywhere, small_camera(40, 24)), ::testing::Each(1)) << "perspective";
  EXPECT_THAT(coverage(anywhere, orthographic_square(2, 32)), ::testing::Each(1)) << "orthographic";
}

TEST(Rasterize, EdgesThroughPixelCentresBelongToOneTriangle) {
  // Quads of 4 pixels whose corners move by half pixels: corners and edges meet pixel centres all
  // the time.
  const SceneData scene = jittered_plane(8, 2, 4, 0.125f);
  EXPECT_THAT(coverage(scene, orthographic_square(1.5f, 24)), ::testing::Each(1));
}

TEST(Rasterize, NearPlaneCutsWithoutHoles) {
  // A floor that passes under and behind the eye: everything below the horizon is covered, once.
  SceneData scene = jittered_plane(6, 3, 0, 0);
  scene.materials[0].flags = CLPV_MATERIAL_DOUBLE_SIDED;
  for (Vertex& vertex : scene.vertices)
    vertex.position[2] = vertex.position[1], vertex.position[1] = -0.3f;
  SceneCamera camera = camera_at({0, 0, 0}, {0, -1, -1});
  camera.vertical_fov = 1.4f;
  const ClpvView view = camera_view(camera, 36, 36);
  const std::vector<int> count = coverage(scene, view);
  for (const int c : count) EXPECT_LE(c, 1);
  const SurfaceImage image = drawn(scene, view);
  for (unsigned y = 0; y < 36; ++y) {
    for (unsigned x = 0; x < 36; ++x) {
      const glm::vec3 ray = glm::vec3(view.forward[0], view.forward[1], view.forward[2]) +
                            (2 * (x + 0.5f) / 36 - 1) * view.half_width * glm::vec3(1, 0, 0) +
                            (1 - 2 * (y + 0.5f) / 36) * view.half_height *
                                glm::vec3(view.up[0], view.up[1], view.up[2]);
      const float depth = ray.y < 0 ? -0.3f / ray.y : 1e9f;
      const glm::vec3 hit = depth * ray;
      if (depth > view.near_depth * 1.01f && std::abs(hit.x) < 2.3f && std::abs(hit.z) < 2.3f) {
        ASSERT_EQ(count[y * 36 + x], 1) << x << "," << y;
        ASSERT_NEAR(image.depth[y * 36 + x], depth, 1e-5f * depth);
      }
    }
  }
}

TEST(Rasterize, FarawayCornersAreClippedToTheGuardBand) {
  // 40,000 km to each side: without clipping its corners overflow the screen's integers.
  SceneData scene;
  add_quad(scene, {-4e7f, -4e7f, -4}, {8e7f, 0, 0}, {0, 8e7f, 0}, add_material(scene));
  for (const float depth : drawn(scene, small_camera()).depth) EXPECT_NEAR(depth, 4, 1e-4);
  for (const float depth : shadow_depth(scene, orthographic_square(1, 16)))
    EXPECT_NEAR(depth, 4, 1e-4);
}

TEST(Rasterize, NearerSurfaceWinsAndTiesGoToTheFirst) {
  SceneData scene;
  const unsigned red = add_material(scene, {1, 0, 0}), green = add_material(scene, {0, 1, 0});
  add_quad(scene, {-9, -9, -4}, {18, 0, 0}, {0, 18, 0}, red);
  add_quad(scene, {-9, -9, -4}, {18, 0, 0}, {0, 18, 0}, green);
  for (const glm::vec4& colour : drawn(scene, small_camera()).colour) EXPECT_FLOAT_EQ(colour.x, 1);
  add_quad(scene, {-9, -9, -3.99f}, {18, 0, 0}, {0, 18, 0}, green);
  for (const glm::vec4& colour : drawn(scene, small_camera()).colour) EXPECT_FLOAT_EQ(colour.y, 1);
}

TEST(Rasterize, ATileOfMoreTrianglesThanOneLoopCanDraw) {
  SceneData scene;
  const unsigned material = add_material(scene);
  const auto wall_at = [&](float depth) {
    add_quad(scene, {-20, -20, -depth}, {40, 0, 0}, {0, 40, 0}, material);
  };
  for (unsigned i = 0; i < CLPV_LONGEST_LOOP; ++i) wall_at(5);  // two triangles each
  wall_at(4.9995f);  // in the same slice; work-items enter it in any order, but late
  for (const float depth : drawn(scene, small_camera(8, 8)).depth) EXPECT_FLOAT_EQ(depth, 4.9995f);
}

TEST(Rasterize, OrthographicDepthsBeforeTheNearOneClampToItAndFarOnesDrop) {
  const ClpvView view = orthographic_square(1, 8, 2, 10);
  EXPECT_THAT(shadow_depth(wall(4), view), ::testing::Each(4.0f));
  EXPECT_THAT(shadow_depth(wall(1), view), ::testing::Each(2.0f));   // before the near depth
  EXPECT_THAT(shadow_depth(wall(-3), view), ::testing::Each(2.0f));  // behind the eye
  EXPECT_THAT(shadow_depth(wall(11), view), ::testing::Each(0.0f));
}

TEST(Rasterize, FluxInAWhiteRoomIsThatOfThePointLight) {
  SceneData scene;  // a cube around the light, seen from inside
  test::add_box(scene, glm::vec3(-2), 4, add_material(scene));
  const ClpvLight light = test::point_light({0.3f, 0.2f, -0.4f}, {1, 1, 1});
  double sum = 0;
  for (const ClpvView& view : point_views(light, 32, {glm::vec3(-2), glm::vec3(2)})) {
    const SurfaceImage image = rsm_image(scene, light, view);
    EXPECT_EQ(covered(image.depth), image.depth.size());
    for (const glm::vec4& flux : image.colour) sum += flux.x;
  }
  // The midpoint rule of 32 x 32 texels over a cube's side.
  EXPECT_NEAR(sum, 4 * glm::pi<double>(), 4e-4 * 4 * glm::pi<double>());
}

TEST(Rasterize, PaperFormatKeepsEightBits) {
  SceneData scene;
  add_quad(scene, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20}, add_material(scene, {0.9f, 0.5f, 0.1f}));
  const ClpvLight light = directional_light({0.3f, -1, 0.2f}, glm::vec3(3));
  const ClpvView view =
      directional_rsm_view(light, {{-2, -2, -2}, 0.5f, 8, {}}, {{-10, 0, -10}, {10, 0, 10}}, 16);
  const SurfaceImage exact = rsm_image(scene, light, view);
  const SurfaceImage coarse = rsm_image(scene, light, view, RsmFormat::paper);
  EXPECT_EQ(exact.depth, coarse.depth);
  const float most = 3 * 4 * view.half_width * view.half_height / (16 * 16);
  for (std::size_t i = 0; i < exact.colour.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(exact.colour[i][c], coarse.colour[i][c], most * 0.5f / 255 * 1.0001f);
      EXPECT_NEAR(exact.normal[i][c], coarse.normal[i][c], 0.5f / 127);
    }
  }
}

TEST(Rasterize, ListsThatNoBufferHoldsAreDrawnInParts) {
  SceneData scene;
  for (int i = 0; i < 400; ++i)
    add_quad(scene, {-20, -20, -9.0f + 0.01f * static_cast<float>(i)}, {40, 0, 0}, {0, 40, 0},
             add_material(scene, glm::vec3(0.001f * static_cast<float>(i))));
  const ClpvView view = small_camera(160, 90);
  const SurfaceImage whole = drawn(scene, view);
  Device device = choose_device();
  device.max_alloc_bytes = 1u << 20;  // a fourth of what the entries need
  Session session(device);
  Rasterizer rasterizer(session, upload_scene(session, scene));
  Surface surface = make_surface(session, view, RsmFormat::float32, true);
  rasterizer.rasterize_camera(surface);
  const SurfaceImage parts = read_surface(session, surface);
  EXPECT_EQ(whole.depth, parts.depth);
  EXPECT_EQ(whole.colour, parts.colour);
}

/// Heaps of 64 triangles, one cluster each, at different depths, some of them behind a wall over
/// the left half of the view.
SceneData heaps() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  SceneData scene;
  const unsigned material = add_material(scene);
  for (int heap = 0; heap < 60; ++heap) {
    const glm::vec3 middle(4 * uniform(random), 4 * uniform(random), -10 + 8 * uniform(random));
    for (int quad = 0; quad < CLPV_CLUSTER / 2; ++quad) {
      const glm::vec3 by(uniform(random), uniform(random), 0.2f * uniform(random));
      add_quad(scene, middle + 0.6f * by, {0.3f, 0, 0.1f}, {0, 0.3f, -0.2f}, material);
    }
  }
  add_quad(scene, {-4, -4, -6}, {4, 0, 0.5f}, {0, 8, -0.5f}, material);
  return scene;
}

// Clusters that are hidden, and views that the same launches draw, change nothing.
TEST(Rasterize, MapsDrawnTogetherAreThoseDrawnAlone) {
  constexpr int kSize = 61;
  constexpr std::size_t kTexels = kSize * kSize;
  const SceneData scene = heaps();
  const ClpvLight light = directional_light({0, 0, -1}, glm::vec3(3));
  Session& session = test_session();
  std::vector<ClpvView> views(5, orthographic_square(4, kSize));
  views[1].eye[0] = 1, views[2].half_width = 0.5f, views[4] = small_camera(kSize, kSize);
  for (const unsigned least_hidden : {UINT_MAX, 1u}) {
    Rasterizer rasterizer(session, upload_scene(session, scene), Rasterizer::kMaxListed,
                          least_hidden);
    std::vector<Surface> maps(views.size(), make_surface(session, views[0], RsmFormat::float32,
                                                         false, static_cast<int>(views.size())));
    std::vector<Rasterizer::Rsm> drawn;
    for (std::size_t i = 0; i < views.size(); ++i) {
      maps[i].view = views[i], maps[i].first = i * kTexels;
      drawn.push_back({light, &maps[i]});
    }
    rasterizer.rasterize_rsms(drawn);
    Buffer depth = session.buffer(kTexels * sizeof(float), "depth");
    for (std::size_t i = 0; i < views.size(); ++i) {
      SCOPED_TRACE(i);
      const SurfaceImage together = read_surface(session, maps[i]),
                         alone = rsm_image(scene, light, views[i]);
      EXPECT_GT(covered(alone.depth), 0u);
      EXPECT_EQ(together.depth, alone.depth);
      EXPECT_EQ(together.normal, alone.normal);
      EXPECT_EQ(together.colour, alone.colour);
      rasterizer.rasterize_shadow(views[i], depth);
      EXPECT_EQ(session.read<float>(depth, kTexels), alone.depth);
    }
  }
}

TEST(Rasterize, DrawnAheadIsTheSameWithListsThatAreTooShort) {
  SceneData scene = jittered_plane(20, 5, 4, 0);
  for (int i = 0; i < 200; ++i) {  // through the near plane, and each over the whole screen
    add_quad(scene, {-300, -40, -50.0f - static_cast<float>(i)}, {600, 0, 0}, {0, 80, 90},
             add_material(scene, {0.5f, 0.25f, 0.75f}));
  }
  const ClpvView small = small_camera(16, 9), large = small_camera(320, 180);
  const SurfaceImage whole = drawn(scene, large);
  Session& session = test_session();
  Rasterizer rasterizer(session, upload_scene(session, scene));
  rasterizer.draw_ahead(true);
  session.timeline().clear();
  drawn(rasterizer, small);
  EXPECT_GE(session.timeline().host().waits, 1u) << "the first view waits";
  for (const char* time : {"lists too short", "lists of the right length"}) {
    Surface surface = make_surface(session, large, RsmFormat::float32, false);
    session.timeline().clear();
    rasterizer.rasterize_camera(surface);
    EXPECT_EQ(session.timeline().host().waits, 0u) << time;
    const SurfaceImage ahead = read_surface(session, surface);
    EXPECT_EQ(whole.depth, ahead.depth) << time;
    EXPECT_EQ(whole.normal, ahead.normal) << time;
    EXPECT_EQ(whole.colour, ahead.colour) << time;
  }
}

TEST(Rasterize, InconsistentScenesAreRejected) {
  const std::vector<std::function<void(SceneData&)>> faults = {
      [](SceneData& scene) { scene.triangles[1].vertex[2] = 4; },
      [](SceneData& scene) { scene.triangles[0].material = 1; },
      [](SceneData& scene) { scene.materials[0].texture = 0; },
      [](SceneData& scene) {
        scene.materials[0].texture = 0, scene.textures.resize(1);
      },  // no texels
  };
  for (const auto& fault : faults) {
    SceneData scene = wall();
    fault(scene);
    EXPECT_THROW(upload_scene(test_session(), scene), Error);
  }
}

}  // namespace clpv::rasterize_test
