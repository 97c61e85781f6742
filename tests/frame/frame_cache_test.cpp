// SPDX-License-Identifier: MIT
// Results whose inputs did not change are not recomputed, and a frame does not depend on the frames
// before it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "device/result_keys.hpp"
#include "options/render_options.hpp"
#include "options/scene_options.hpp"
#include "pipeline/frame/cached.hpp"
#include "pipeline/frame/frame.hpp"
#include "scene/load.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::frame_cache_test {
TEST(Cached, HoldsNothingAfterAFailure) {
  Cached cached;
  cached.update(1, [] {});
  EXPECT_THROW(cached.update(2, [] { throw std::runtime_error("no memory"); }), std::runtime_error);
  int computed = 0;
  cached.update(1, [&] { ++computed; });
  EXPECT_EQ(computed, 1);
}

using nlohmann::json;
using Passes = std::set<Pass>;

constexpr int kGrid = 16, kCascades = 2;
constexpr float kSize = 3;  // [m], of the finest cascade
constexpr float kCell = kSize / kGrid;
const Passes kOfEveryFrame{Pass::rasterize_camera, Pass::gather, Pass::near, Pass::shade};

/// Times of the scene's parts [s], and the camera's place.
struct Instants {
  glm::vec3 eye{0.1f * kCell, 1.6f, 3.1f};
  double wall = 0, sun = 0;
};

struct CachedFrame : ::testing::Test {
  /// `change_scene`: of the scene file and the model.
  explicit CachedFrame(const std::function<void(RenderOptions&)>& change = {},
                       const std::function<void(json&, json&)>& change_scene = {})
      : moving_(write_scene(folder_, change_scene)),
        options_(options(change)),
        scene_(moving_.scene()),
        frame_(session_, scene_, options_) {}

  static std::filesystem::path write_scene(const test::TemporaryFolder& folder,
                                           const std::function<void(json&, json&)>& change) {
    const std::filesystem::path file = test::write_moving_scene(folder);
    if (!change) return file;
    json scene = json::parse(test::read_file(file)),
         model = json::parse(test::read_file(folder / "model.gltf"));
    change(scene, model);
    folder.write("model.gltf", model.dump());
    return folder.write("moving.json", scene.dump());
  }

  static RenderOptions options(const std::function<void(RenderOptions&)>& change) {
    RenderOptions options = test::small_sweep();
    options.bounces = Bounces::all;
    if (change) change(options);
    options.grid = kGrid, options.width = 32, options.height = 18, options.rsm_size = 64,
    options.shadow_size = 64;
    options.cascades = kCascades, options.cascade_size = double{kSize};
    return options;
  }

  SceneCamera show(const Instants& at) {
    moving_.pose(at.sun);
    scene_.lights = moving_.scene().lights;
    moving_.pose(at.wall);
    scene_.vertices = moving_.scene().vertices;
    frame_.scene_moved();
    SceneCamera camera = moving_.scene().camera("");
    camera.eye = at.eye;
    return camera;
  }

  /// A frame's images and light volumes.
  using Found = std::vector<std::vector<float>>;
  static Found rendered(Session& session, Frame& frame, const SceneCamera& camera) {
    frame.render(camera);
    Found found{frame.read(Show::full), frame.read(Show::irradiance)};
    for (const Volume* volume : frame.light().accumulated) found.push_back(volume->read(session));
    return found;
  }

  /// Renders the frame at those instants, compares it with the same frame rendered alone, and
  /// returns its passes.
  Passes passes(const Instants& at) {
    const SceneCamera camera = show(at);
    const Found kept = rendered(session_, frame_, camera);
    Passes passes;
    for (const StageTime& time : session_.timeline().times()) passes.insert(time.mark.pass);
    Frame alone(session_, scene_, options_);
    const Found fresh = rendered(session_, alone, camera);
    EXPECT_EQ(kept.size(), fresh.size());
    for (std::size_t i = 0; i < fresh.size(); ++i) EXPECT_TRUE(kept[i] == fresh[i]) << i;
    return passes;
  }

  test::TemporaryFolder folder_;
  MovingScene moving_;
  RenderOptions options_;
  Session& session_ = test::test_session();
  SceneData scene_;
  Frame frame_;
};

Passes with(Passes passes, const Passes& more) {
  passes.insert(more.begin(), more.end());
  return passes;
}

const Passes kOfLight{Pass::rasterize_shadow, Pass::rasterize_rsm, Pass::inject_light,
                      Pass::propagate};
const Passes kOfView{Pass::near_trace};
const Passes kOfCells{Pass::visibility, Pass::reflectors};

TEST_F(CachedFrame, RecomputesOnlyWhatChanged) {
  Instants at;
  const Passes all = with(with(with(kOfEveryFrame, kOfView), kOfLight), kOfCells);
  EXPECT_EQ(passes(at), all);
  EXPECT_EQ(passes(at), kOfEveryFrame) << "nothing changed";
  at.eye.x += 0.5f * kCell;
  EXPECT_EQ(passes(at), with(kOfEveryFrame, kOfView)) << "a camera that moves inside a cell";
  at.sun = 0.3;
  EXPECT_EQ(passes(at), with(kOfEveryFrame, kOfLight));
  at.wall = 0.6;
  EXPECT_EQ(passes(at), all);
  EXPECT_EQ(passes(at), kOfEveryFrame);
  at.eye.x += kCell;
  EXPECT_EQ(passes(at), with(with(with(kOfEveryFrame, kOfView), kOfCells),
                             {Pass::rasterize_rsm, Pass::inject_light, Pass::propagate}))
      << "the shadow map stands";
  at.wall = at.sun = 2;  // after the last key
  EXPECT_EQ(passes(at), all);
  at.wall = at.sun = 5;
  EXPECT_EQ(passes(at), kOfEveryFrame) << "nothing moves any more";
  EXPECT_EQ(passes(Instants{}), all);
}

TEST_F(CachedFrame, IsTheSameAlongAPathAcrossCells) {
  Instants at;
  // Steps across cells of the finest cascade, of both cascades, and within a cell, with and without
  // moving objects.
  for (int i = 0; i < 16; ++i) {
    at.eye[i % 2 == 0 ? 0 : 2] += (i % 2 == 0 ? 0.7f : -0.7f) * kCell;
    if (i % 6 == 1) at.sun += 0.1;
    if (i % 7 == 5) at.wall += 0.1;
    passes(at);
  }
}

TEST_F(CachedFrame, AnObserverReceivesSharedVolumes) {
  const Instants at;
  using Seen = std::vector<std::vector<float>>;
  const auto observed = [&] {
    Seen seen;
    frame_.render(show(at), [&](const CascadeVolumes& volumes) {
      seen.push_back(volumes.injected.read(session_));
      seen.push_back(volumes.accumulated.read(session_));
    });
    return seen;
  };
  const Seen recomputed = observed();
  ASSERT_EQ(recomputed.size(), 4u);
  EXPECT_FALSE(recomputed[0] == recomputed[2]) << "a cascade's own";
  EXPECT_TRUE(observed() == recomputed);
}

/// A sky, a medium and an emissive wall of a masked material, which blocks by its area.
struct CachedAll : CachedFrame {
  CachedAll()
      : CachedFrame({}, [](json& scene, json& model) {
          scene["sky"] = {{"radiance", {0.5, 1, 2}}};
          scene["medium"] = {{"scattering", {0.2, 0.2, 0.2}}, {"anisotropy", 0.3}};
          model["materials"][0]["emissiveFactor"] = {1, 0.5, 0.25};
          model["materials"][0]["alphaMode"] = "MASK";
        }) {}
};

TEST_F(CachedAll, RecomputesOnlyWhatChanged) {
  const Passes always = with(kOfEveryFrame, {Pass::medium}),
               of_cells = with(kOfCells, {Pass::blockers});
  Instants at;
  const Passes all = with(with(with(with(always, kOfView), kOfLight), of_cells), {Pass::emit});
  EXPECT_EQ(passes(at), all);
  EXPECT_EQ(passes(at), always);
  at.eye.x += 0.5f * kCell;
  EXPECT_EQ(passes(at), with(always, kOfView));
  at.sun = 0.3;
  EXPECT_EQ(passes(at), with(always, kOfLight)) << "scattered sunlight too; the wall is still";
  at.wall = 0.6;
  EXPECT_EQ(passes(at), all) << "it emits, and shadows the sky";
  at.eye.x += kCell;
  EXPECT_EQ(passes(at), with(with(with(always, kOfView), of_cells),
                             {Pass::rasterize_rsm, Pass::inject_light, Pass::propagate}))
      << "the emitted light of the scene's triangles stands";
  frame_.invalidate_light();
  EXPECT_EQ(passes(at), with(with(with(always, kOfView), kOfLight), {Pass::emit}));
}

TEST(FrameKeys, ChangeWithEachInput) {
  const test::TemporaryFolder folder;
  Device device;
  device.platform = "A", device.name = "B", device.driver = "C", device.compute_units = 2;
  RenderOptions options;
  std::set<std::string> pixels, times;
  const auto both = [&](const char* what) {
    EXPECT_TRUE(pixels.insert(pixels_key(device, options)).second) << what;
    EXPECT_TRUE(times.insert(times_key(device, options, 2)).second) << what;
  };
  const auto only_times = [&](const char* what, int processors = 2) {
    EXPECT_FALSE(pixels.insert(pixels_key(device, options)).second) << what;
    EXPECT_TRUE(times.insert(times_key(device, options, processors)).second) << what;
  };
  both("first");
  device.platform = "A2", both("platform");
  device.platform_version = "A3", both("version of the platform");
  device.name = "B2", both("device");
  device.driver = "C2", both("driver");
  device.lanes = 1, both("lanes");
  options.grid = 8, both("options");
  options.centres = folder.write("set.json", R"({"centres": [[1, 0, 0], [0, 1, 0]]})").string();
  both("centres");
  folder.write("set.json", R"({"centres": [[1, 0, 0], [0, 0, 1]]})"), both("their content");

  const test::Variable kernels("CLPV_KERNEL_DIR", folder.path().string());
  folder.write("gather/gather.cl", "#include \"mine.h\"\n"), both("a kernel");
  folder.write("mine.h", "#include \"more.h\"\n"), both("a file that it includes");
  folder.write("more.h", "a"), both("a file that that one includes");
  folder.write("more.h", "b"), both("its content");
  const test::Variable flags("POCL_EXTRA_BUILD_FLAGS", "-g");
  both("flags of the driver");

  const test::Variable threads("POCL_MAX_PTHREAD_COUNT", "1");
  only_times("threads");
  device.compute_units = 1, only_times("compute units");
  only_times("processors", 1);
  const std::string before = times_key(device, options, 1);
  const test::Variable cache("POCL_CACHE_DIR", folder.path().string());
  EXPECT_EQ(times_key(device, options, 1), before) << "a cache changes nothing";
}

/// Visible surfels are blockers, so blockers and propagation change with the view.
struct CachedPublishedFrame : CachedFrame {
  CachedPublishedFrame()
      : CachedFrame([](RenderOptions& options) {
          apply_preset(options, PresetName::paper);
          options.bounces = Bounces::one;
          options.basis = "sh2", options.layout = Layout::soa, options.lobe_time = LobeTime::host;
          options.iterations = 3;
        }) {}
};

TEST_F(CachedPublishedFrame, RecomputesOnlyWhatChanged) {
  const Passes always{Pass::rasterize_camera, Pass::gather, Pass::shade},
      of_view{Pass::inject_geometry, Pass::propagate};
  Instants at;
  const Passes all = with(with(always, kOfLight), of_view);
  EXPECT_EQ(passes(at), all);
  EXPECT_EQ(passes(at), always);
  at.eye.x += 0.5f * kCell;
  EXPECT_EQ(passes(at), with(always, of_view)) << "maps of lights and their injected light stand";
  at.sun = 0.3;
  EXPECT_EQ(passes(at), all);
  at.wall = 0.6;
  EXPECT_EQ(passes(at), all);
  frame_.invalidate_light();
  EXPECT_EQ(passes(at), all);
  for (int i = 0; i < 5; ++i) {
    at.eye += glm::vec3(0.6f, 0.0f, -0.55f) * kCell;
    if (i % 3 == 1) at.sun += 0.1;
    passes(at);
  }
}

// A later change that adds launches, waits or arguments fails here (docs/gpu.md, 'What a frame
// launches').
TEST(FrameWork, DoesNotGrow) {
  struct Row {
    int lanes;
    unsigned launches, fills, waits, arguments;
  };
  const SceneData scene = load_scene(CLPV_SOURCE_DIR "/scenes/atrium.json");
  for (const Row& row : {Row{1, 82, 1, 0, 92}, Row{8, 100, 1, 5, 111}}) {
    SCOPED_TRACE(row.lanes);
    Device device = choose_device();
    device.lanes = row.lanes;
    Session session(device);
    Frame frame(session, scene,
                resolve_options({{"width", "64"}, {"height", "36"}, {"near-size", "half"}}, scene));
    for (int i = 0; i < 3; ++i) {  // lists of triangles have their size after two
      frame.invalidate_light();
      frame.render(scene.camera(""));
    }
    const HostWork& host = session.timeline().host();
    EXPECT_GT(host.launches, 0u);
    EXPECT_LE(host.launches, row.launches);
    EXPECT_LE(host.fills, row.fills);
    EXPECT_LE(host.waits, row.waits);
    EXPECT_LE(host.arguments, row.arguments);
  }
}

}  // namespace clpv::frame_cache_test
