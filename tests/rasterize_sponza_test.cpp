// SPDX-License-Identifier: MIT
// The rasteriser on a whole scene, where it is present: no holes, the same bytes twice, and how long it takes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "pipeline/cascade.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/view.hpp"
#include "scene/load.hpp"
#include "tests/support/on_device.hpp"

namespace clpv::rasterize_sponza_test {
namespace {

using test::test_session;

/// Sponza, uploaded once; or nothing, where it is absent.
struct Sponza {
  Scene scene;
  SceneBuffers buffers;

  static const Sponza* get() {
    static const std::unique_ptr<Sponza> sponza = load();
    return sponza.get();
  }

 private:
  static std::unique_ptr<Sponza> load() {
    const char* given = std::getenv("CLPV_SPONZA");
    std::filesystem::path model = std::filesystem::path(CLPV_SOURCE_DIR) / "../shared/scenes/sponza";
    if (given != nullptr) model = given;
    if (std::filesystem::is_directory(model)) model /= "Sponza.gltf";
    if (!std::filesystem::exists(model)) return nullptr;
    auto sponza = std::make_unique<Sponza>();
    sponza->scene = load_scene(std::filesystem::path(CLPV_SOURCE_DIR) / "scenes/sponza.json", {model});
    sponza->buffers = upload_scene(test_session(), sponza->scene);
    return sponza;
  }
};

void print_times(const char* what) {
  for (const StageTime& time : test_session().timeline().times()) {
    fmt::print("{}: {} {:.1f} ms{}\n", what, name_of(time.mark.pass), time.ms,
               time.from_events ? "" : " (wall time)");
  }
}

class SponzaRasterizeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (Sponza::get() == nullptr) GTEST_SKIP() << "Sponza is absent; CLPV_SPONZA says where it lies";
  }
  void TearDown() override { test_session().timeline().clear(); }
};

TEST_F(SponzaRasterizeTest, CamerasSeeNoHolesAndTheSameTwice) {
  Session& session = test_session();
  const Sponza& sponza = *Sponza::get();
  Rasterizer rasterizer(session, sponza.buffers);
  for (const char* name : {"curtains", "columns"}) {  // neither sees the sky
    Surface surface =
        make_surface(session, camera_view(sponza.scene.camera(name), 960, 540), RsmFormat::float32, false);
    std::vector<std::vector<float>> depths;
    std::vector<std::vector<glm::vec4>> colours;
    for (int run = 0; run < 2; ++run) {
      session.timeline().clear();
      {
        const StageScope scope(session, {.pass = Pass::rasterize_camera});
        rasterizer.rasterize_camera(surface);
      }
      const SurfaceImage image = read_surface(session, surface);
      depths.push_back(image.depth);
      colours.push_back(image.colour);
    }
    print_times(name);
    EXPECT_EQ(std::count(depths[0].begin(), depths[0].end(), 0.0f), 0) << name;
    EXPECT_EQ(depths[0], depths[1]) << name;
    EXPECT_EQ(colours[0], colours[1]) << name;
  }
}

TEST_F(SponzaRasterizeTest, SunSeesTheRoofAndTheFloor) {
  Session& session = test_session();
  const Sponza& sponza = *Sponza::get();
  Rasterizer rasterizer(session, sponza.buffers);
  const Camera& camera = sponza.scene.camera("curtains");
  const ClpvLight sun = sponza.scene.lights_for(camera)[0].data;
  const ClpvGrid cascade = cascade_grids(camera.eye, 3, 12.5, 32)[1];
  Surface surface = make_surface(session, directional_rsm_view(sun, cascade, sponza.buffers.bounds, 256),
                                 RsmFormat::float32, false);
  const ClpvView shadow = shadow_views(sun, sponza.buffers.bounds, 1024)[0];
  Buffer depth = session.buffer(1024 * 1024 * sizeof(float), "shadow map");
  for (int run = 0; run < 2; ++run) {  // the first one compiles
    session.timeline().clear();
    {
      const StageScope scope(session, {.pass = Pass::rasterize_rsm});
      rasterizer.rasterize_rsm(sun, surface);
    }
    const StageScope scope(session, {.pass = Pass::rasterize_shadow});
    rasterizer.rasterize_shadow(shadow, depth);
  }
  print_times("sun");
  std::vector<float> depths = read_surface(session, surface).depth;
  std::erase(depths, 0.0f);
  ASSERT_FALSE(depths.empty());
  // The roof is some 14 m above the floor.
  const auto [nearest, farthest] = std::minmax_element(depths.begin(), depths.end());
  EXPECT_GT(*farthest - *nearest, 12);
  const std::vector<float> map = session.read<float>(depth, 1024 * 1024);
  EXPECT_GT(std::count_if(map.begin(), map.end(), [](float d) { return d > 0; }), 1024 * 1024 / 2);
}

}  // namespace
}  // namespace clpv::rasterize_sponza_test
