// SPDX-License-Identifier: MIT
// Frames whose light is swept: what they do not depend on, every layout, and what they refuse.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <vector>

#include "pipeline/frame.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "tests/support/on_device.hpp"

namespace clpv {
namespace {

using namespace test;

/// A small frame of the Cornell box, swept; `change` of its options.
struct Lit {
  std::vector<std::vector<float>> volumes;  // of what is accumulated and blocks, a cascade, coarsest first
  std::vector<int> blocked, seen;           // cascades whose blockers were made, and what is hidden in them
  double irradiance = 0;                    // sum over all pixels
};

class SweptFrame {
 public:
  explicit SweptFrame(const std::function<void(RenderOptions&)>& change = {})
      : scene_(load_scene(std::filesystem::path(CLPV_SOURCE_DIR) / "scenes/cornell.json")),
        frame_(test_session(), scene_, options(change)) {}

  Lit render(const Camera& camera) {
    Lit lit;
    frame_.render(camera, [&](const CascadeVolumes& volumes) {
      lit.volumes.push_back(volumes.accumulated.read(test_session()));
      if (volumes.geometry != nullptr) lit.volumes.push_back(volumes.geometry->read(test_session()));
    });
    for (const StageTime& time : test_session().timeline().times()) {
      if (time.mark.pass == Pass::block) lit.blocked.push_back(time.mark.cascade.value());
      if (time.mark.pass == Pass::see) lit.seen.push_back(time.mark.cascade.value());
    }
    const std::vector<float> pixels = frame_.read(Show::irradiance);
    for (std::size_t i = 0; i < pixels.size(); ++i) lit.irradiance += i % 4 == 3 ? 0.0 : double{pixels[i]};
    return lit;
  }
  Camera camera() const { return scene_.camera(""); }

 private:
  static RenderOptions options(const std::function<void(RenderOptions&)>& change) {
    RenderOptions options;
    options.transport = TransportKind::sweep, options.blockers = Blockers::scene;
    options.directions = Directions::of24;
    options.width = 48, options.height = 27, options.grid = 16, options.cascade_size = 1.5;
    options.rsm_size = 64, options.shadow_size = 64;
    if (change) change(options);
    return options;
  }
  Scene scene_;
  Frame frame_;
};

TEST(SweptFrame, LightDoesNotDependOnWhereTheCameraLooks) {
  SweptFrame frame;
  Camera camera = frame.camera();
  const Lit ahead = frame.render(camera);
  EXPECT_EQ(ahead.blocked, (std::vector<int>{2, 1, 0}));
  camera.forward = glm::normalize(glm::vec3(1, 0.2f, -0.3f));
  camera.up = glm::normalize(glm::cross(glm::cross(camera.forward, camera.up), camera.forward));
  const Lit aside = frame.render(camera);
  EXPECT_EQ(ahead.seen, ahead.blocked);
  EXPECT_TRUE(aside.blocked.empty() && aside.seen.empty()) << "nothing moved that blocks";
  ASSERT_EQ(ahead.volumes.size(), 6u);
  for (std::size_t i = 0; i < ahead.volumes.size(); ++i)
    EXPECT_TRUE(aside.volumes[i] == ahead.volumes[i]) << i;
  EXPECT_GT(ahead.irradiance, 0);

  camera = frame.camera();
  camera.eye.x += 1.01f * 1.5f / 16;  // a cell of the finest cascade, and half a one of the next
  EXPECT_NE(frame.render(camera).blocked.size(), 0u);
  const Lit back = frame.render(frame.camera());
  for (std::size_t i = 0; i < ahead.volumes.size(); ++i)
    EXPECT_TRUE(back.volumes[i] == ahead.volumes[i]) << i;
}

TEST(SweptFrame, EveryLayoutAndTheBlockersThatAreSeen) {
  const double wanted = SweptFrame().render(SweptFrame().camera()).irradiance;
  for (const Layout layout : values_of<Layout>()) {
    if (unsupported(test_session().device(), {layout, Storage::float32})) continue;
    SweptFrame frame([&](RenderOptions& o) { o.layout = layout, o.storage = Storage::float32; });
    EXPECT_NEAR(frame.render(frame.camera()).irradiance, wanted, 2e-3 * wanted) << name_of(layout);
  }
  SweptFrame seen([](RenderOptions& o) {
    o.blockers = Blockers::seen, o.blocking = Blocking::one_sided, o.basis = "sh2";
  });
  EXPECT_GT(seen.render(seen.camera()).irradiance, 0.3 * wanted);
  SweptFrame open([](RenderOptions& o) { o.occlusion = false; });
  EXPECT_GT(open.render(open.camera()).irradiance, 1.05 * wanted);
}

TEST(SweptFrame, RefusesWhatDoesNotApply) {
  EXPECT_THROW(SweptFrame([](RenderOptions& o) { o.state = State::fluxes; }), Error);
  EXPECT_THROW(SweptFrame([](RenderOptions& o) { o.lobe_time = LobeTime::kernel; }), Error);
  EXPECT_THROW(SweptFrame([](RenderOptions& o) { o.blocking = Blocking::one_sided; }), Error);
}

}  // namespace
}  // namespace clpv
