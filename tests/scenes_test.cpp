// SPDX-License-Identifier: MIT
// The scenes made for this project: their generators write the files that are there, and light falls in them as
// their cards say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "pathtracer/ray_scene.hpp"
#include "scene/emission.hpp"
#include "scene/load.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::scenes_test {
namespace {

namespace fs = std::filesystem;
using reference::Faces;
using reference::RayScene;

const fs::path kScenes = fs::path(CLPV_SOURCE_DIR) / "scenes";
constexpr float kFar = 1000;

std::string camera_names(const Scene& scene) {
  std::string names;
  for (const Camera& camera : scene.cameras) names += camera.name + " ";
  return names;
}

/// Directions spread evenly over the sphere (a Fibonacci lattice).
glm::vec3 spread(int i, int count) {
  const double z = 1 - (2.0 * i + 1) / count, azimuth = i * M_PI * (3 - std::sqrt(5.0));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

/// What is seen from `eye` is seen from its front: no face is turned inside out. Returns how many rays left the scene.
int check_fronts(const RayScene& rays, const glm::vec3& eye) {
  constexpr int kRays = 4000;
  int escaped = 0, turned = 0;
  for (int i = 0; i < kRays; ++i) {
    const glm::vec3 direction = spread(i, kRays);
    const auto seen = rays.intersect(eye, direction, 0, kFar, Faces::as_seen);
    const auto met = rays.intersect(eye, direction, 0, kFar, Faces::both);
    escaped += !met;
    turned += met && (!seen || seen->distance > met->distance * 1.0001f);
  }
  EXPECT_EQ(turned, 0) << "from " << eye.x << ", " << eye.y << ", " << eye.z;
  return escaped;
}

/// Triangles whose vertices' normals point to the other side than their winding, and degenerate ones.
int count_bad_triangles(const Scene& scene) {
  int bad = 0;
  for (const Triangle& triangle : scene.triangles) {
    glm::vec3 p[3], n[3];
    for (int k = 0; k < 3; ++k) {
      const Vertex& v = scene.vertices[triangle.vertex[k]];
      p[k] = {v.position[0], v.position[1], v.position[2]};
      n[k] = {v.normal[0], v.normal[1], v.normal[2]};
    }
    const glm::vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
    for (const glm::vec3& normal : n) {
      if (!(glm::dot(across, normal) > 0)) {
        ++bad;
        break;
      }
    }
  }
  return bad;
}

class Generator : public testing::TestWithParam<const char*> {};

TEST_P(Generator, WritesTheFilesThatAreThere) {
  if (test::run("python3 -c 'import sys; sys.exit(sys.version_info < (3, 9))'").exit_code != 0) {
    GTEST_SKIP() << "needs python3, 3.9 or later";
  }
  const std::string name = GetParam();
  const test::TemporaryFolder folder;
  const test::Outcome outcome =
      test::run("PYTHONDONTWRITEBYTECODE=1 python3 " + (kScenes / ("generate_" + name + ".py")).string() +
                " " + folder.path().string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  int files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path())) {
    const fs::path file = entry.path().filename();
    EXPECT_TRUE(test::read_file(entry.path()) == test::read_file(kScenes / file))
        << file << " differs from the committed one";
    ++files;
  }
  EXPECT_EQ(files, name == "atrium" ? 5 : 4) << "models and scene files";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Generator, testing::Values("atrium", "cornell"),
                         [](const auto& info) { return std::string(info.param); });

class Atrium : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<Scene>(load_scene(kScenes / "atrium.json"));
    rays_ = std::make_unique<RayScene>(*scene_);
  }
  static void TearDownTestSuite() {
    rays_.reset();
    scene_.reset();
  }
  /// Whether the sun reaches that point.
  static bool sunlit(float x, float y, float z) {
    const float* d = scene_->lights[0].data.direction;
    return !rays_->occluded({x, y, z}, {-d[0], -d[1], -d[2]}, kFar);
  }
  static inline std::unique_ptr<Scene> scene_;
  static inline std::unique_ptr<RayScene> rays_;
};

TEST_F(Atrium, IsWhatItsCardSays) {
  EXPECT_EQ(scene_->triangles.size(), 266672u);
  EXPECT_LT(fs::file_size(kScenes / "atrium.glb"), 1900000u);
  EXPECT_EQ(camera_names(*scene_), "nave curtains gallery ");
  EXPECT_EQ(scene_->lights.size(), 1u);
  EXPECT_TRUE(scene_->notes.empty()) << scene_->notes[0];
  const glm::vec3 size = scene_->upper - scene_->lower;
  EXPECT_NEAR(size.x, 30.0f, 0.01f);
  EXPECT_NEAR(size.y, 10.0f, 0.01f);
  EXPECT_NEAR(size.z, 14.15f, 0.01f);
  EXPECT_EQ(count_bad_triangles(*scene_), 0);
}

TEST_F(Atrium, SunFallsOnTheFloorAndOneRowOfCurtains) {
  const float bay = 2.75f;
  for (int i = 1; i < 8; ++i) {  // the west side shades the first bay
    const float x = (static_cast<float>(i) - 3.5f) * bay;
    EXPECT_TRUE(sunlit(x, 0.01f, -1.8f)) << x;
    EXPECT_EQ(sunlit(x, 0.01f, 0.6f), i != 5) << x;  // the basin stands in that bay
    EXPECT_FALSE(sunlit(x, 0.01f, 0.75f)) << x;
    EXPECT_TRUE(sunlit(x, 1.5f, -2.8f)) << x;  // before the lit row
    EXPECT_FALSE(sunlit(x, 1.5f, 2.8f)) << x;  // before the other one
  }
  EXPECT_NEAR(-scene_->lights[0].data.direction[1] * scene_->lights[0].data.intensity[0], 15.7f, 0.05f);
}

TEST_F(Atrium, NoSunLeaksIntoTheAisles) {
  for (float x = -14; x <= 14; x += 0.5f) {
    for (const float side : {-1.0f, 1.0f}) {
      EXPECT_FALSE(sunlit(x, 0.05f, side * 6.1f)) << x;
      EXPECT_FALSE(sunlit(x, 4.4f, side * 6.1f)) << x;
      EXPECT_FALSE(sunlit(x, 8.7f, side * 6.1f)) << x;
      EXPECT_FALSE(sunlit(side * 14.1f, 1.0f, 0.4f * x)) << x;
    }
  }
}

TEST_F(Atrium, EveryFaceShowsItsFrontAndTheSkyIsOpen) {
  for (const glm::vec3& eye : {glm::vec3(-9.6f, 1.75f, 1.9f), glm::vec3(0, 3, -1), glm::vec3(2, 1, 2.2f)}) {
    EXPECT_GT(check_fronts(*rays_, eye), 50);
  }
  for (const glm::vec3& eye : {glm::vec3(1, 1.5f, -5.5f), glm::vec3(1, 1.5f, 5.5f), glm::vec3(13.9f, 0.5f, 0),
                               glm::vec3(0, 6.5f, -5), glm::vec3(-13, 8.2f, 1)}) {
    check_fronts(*rays_, eye);
  }
  for (const Camera& camera : scene_->cameras) check_fronts(*rays_, camera.eye);
}

TEST(Cornell, HasThePublishedSizeAndItsLightsReachBothWalls) {
  const Scene scene = load_scene(kScenes / "cornell.json");
  EXPECT_EQ(scene.triangles.size(), 48u);
  EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
  EXPECT_EQ(camera_names(scene), "front published red green ");
  EXPECT_EQ(count_bad_triangles(scene), 0);

  const RayScene rays(scene);
  const glm::vec3 middle(0.15f, 0.45f, 0.5f);
  const auto distance = [&](const glm::vec3& direction) {
    const auto hit = rays.intersect(middle, direction, 0, kFar, Faces::as_seen);
    return hit ? hit->distance : kFar;
  };
  EXPECT_NEAR(distance({0, -1, 0}), 0.45f, 1e-5f);
  EXPECT_NEAR(distance({0, 1, 0}), 0.5488f - 0.45f, 1e-5f);
  EXPECT_NEAR(distance({0, 0, 1}), 0.5592f - 0.5f, 1e-5f);
  EXPECT_NEAR(distance({-1, 0, 0}), 0.15f, 1e-5f);
  EXPECT_NEAR(distance({1, 0, 0}), 0.554f - 0.15f, 0.004f);
  EXPECT_EQ(distance({0, 0, -1}), kFar);
  const auto reaches = [&](int light, const glm::vec3& point) {
    const float* d = scene.lights[light].data.direction;
    return !rays.occluded(point, {-d[0], -d[1], -d[2]}, kFar);
  };
  ASSERT_EQ(scene.lights.size(), 2u);
  const glm::vec3 at_red(0.54f, 0.2f, 0.2f), at_green(0.01f, 0.2f, 0.2f), at_back(0.28f, 0.4f, 0.55f);
  EXPECT_TRUE(reaches(0, at_red) && !reaches(0, at_green) && !reaches(0, at_back));
  EXPECT_TRUE(reaches(1, at_green) && !reaches(1, at_red) && !reaches(1, at_back));
  for (const Camera& camera : scene.cameras) check_fronts(rays, camera.eye);
  // The published camera looks along +z with y up: x grows to its left, where the red wall is.
  const glm::vec3 right = glm::cross(scene.cameras[1].forward, scene.cameras[1].up);
  EXPECT_LT(right.x, -0.99f);
}

TEST(CornellLamp, HasThePublishedLampInItsCeiling) {
  const Scene scene = load_scene(kScenes / "cornell_lamp.json");
  EXPECT_EQ(scene.triangles.size(), 48u - 2 + 8 + 2);
  EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(count_bad_triangles(scene), 0);
  const std::vector<std::uint32_t> lamp = emissive_triangles(scene);
  ASSERT_EQ(lamp.size(), 2u);
  EXPECT_NEAR(most_emitted(scene, lamp, kFar), M_PI * 17.2 * 0.130 * 0.105, 1e-4);
  const RayScene rays(scene);
  for (int i = 0; i < 40;
       ++i) {  // up from the floor: the ceiling has no gap, and the lamp is where it should be
    const glm::vec3 from(0.02f + 0.013f * static_cast<float>(i), 0.4f, 0.28f);
    const auto hit = rays.intersect(from, {0, 1, 0}, 0, kFar, Faces::as_seen);
    ASSERT_TRUE(hit) << i;
    EXPECT_NEAR(hit->position.y, 0.5488f, 1e-6f) << i;
    const bool within = from.x > 0.213f && from.x < 0.343f;
    EXPECT_EQ(std::ranges::count(lamp, hit->point.triangle), within ? 1 : 0) << i;
  }
}

/// The least corner of what moves of a scene, and the greatest.
std::pair<glm::vec3, glm::vec3> box_of(const Scene& scene, const Part& part) {
  glm::vec3 lower(kFar), upper(-kFar);
  for (std::uint32_t i = 0; i < part.vertices; ++i) {
    const float* p = scene.vertices[part.first_vertex + i].position;
    lower = glm::min(lower, glm::vec3(p[0], p[1], p[2]));
    upper = glm::max(upper, glm::vec3(p[0], p[1], p[2]));
  }
  return {lower, upper};
}

TEST(AtriumLiving, StandsAsTheAtriumDoes) {
  const Scene still = load_scene(kScenes / "atrium.json"),
              living = load_scene(kScenes / "atrium_living.json");
  ASSERT_EQ(living.moving.size(), 2u) << "a curtain and a ball";
  EXPECT_EQ(living.triangles.size(), still.triangles.size() + living.moving.back().triangles);
  EXPECT_EQ(living.textures.size(), still.textures.size());
  EXPECT_EQ(living.lower, still.lower);
  EXPECT_EQ(living.upper, still.upper);
}

TEST(AtriumLiving, TheBallBouncesOnTheFloorAndTheWayIsFree) {
  MovingScene moving(kScenes / "atrium_living.json");
  float highest = 0;
  for (int i = 0; i <= 200; ++i) {
    moving.pose(i / 20.0);
    const auto [lower, upper] = box_of(moving.scene(), moving.scene().moving.back());
    EXPECT_GT(lower.y, -1e-4f) << i / 20.0 << " s";
    EXPECT_NEAR(upper.y - lower.y, 0.9f, 1e-2f) << i / 20.0 << " s";
    highest = std::max(highest, lower.y);
  }
  EXPECT_NEAR(highest, 4.6 * 4.6 / (2 * 9.81), 1e-2) << "v^2 / 2g";
  for (const double seconds : {0.0, 2.5, 5.0, 7.5, 10.0}) {
    moving.pose(seconds);
    const RayScene rays(moving.scene());
    const glm::vec3 eye = moving.scene().camera("walk").eye;
    for (int i = 0; i < 500; ++i)
      EXPECT_FALSE(rays.intersect(eye, spread(i, 500), 0, 0.5f, Faces::both)) << seconds << " s";
    EXPECT_LT(check_fronts(rays, eye), 2000) << "no way out but the sky";
  }
}

TEST(AtriumLiving, TheCurtainLetsTheSunIntoTheAisle) {
  MovingScene moving(kScenes / "atrium_living.json");
  moving.pose(5.5);
  // From the aisle's floor behind the curtain's middle, against the light.
  const float* light = moving.scene().lights[0].data.direction;
  const auto [lower, upper] = box_of(moving.scene(), moving.scene().moving.front());
  const glm::vec3 behind(lower.x + 1.6f, 0.5f, lower.z - 0.15f), to_sun(-light[0], -light[1], -light[2]);
  EXPECT_FALSE(RayScene(moving.scene()).intersect(behind, to_sun, 0, kFar, Faces::both)) << "open";
  moving.pose(0);
  EXPECT_TRUE(RayScene(moving.scene()).intersect(behind, to_sun, 0, kFar, Faces::both)) << "shut";
}

}  // namespace
}  // namespace clpv::scenes_test
