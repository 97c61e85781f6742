// SPDX-License-Identifier: MIT
// Baselines of clpv quality against path tracing and closed forms, and their options.

#include "baselines/baseline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "additions.hpp"
#include "baselines/methods.hpp"
#include "baselines/radiance_cascades.hpp"
#include "image/compare.hpp"
#include "image/image_io.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/quality_room.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/traced_scenes.hpp"
#include "times/time_record.hpp"

namespace clpv::baseline_test {

namespace fs = std::filesystem;
using std::numbers::pi_v;
using test::QualityCommand;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kWidth = 48, kHeight = 27;

using test::camera_at;
using test::scene_file;

/// The Cornell box with a budget from a frame, and its ground truth.
struct Cornell : ::testing::Test {
  static void SetUpTestSuite() {
    scene_ = std::make_unique<SceneData>(load_scene(scene_file("cornell.json")));
    camera_ = scene_->camera("front");
    view_ = std::make_unique<baselines::View>(*scene_, camera_, kWidth, kHeight, 1, 2);
    RenderOptions options;
    options.width = kWidth, options.height = kHeight;
    options.cascades = scene_->cascades.value(),
    options.cascade_size = scene_->cascade_size.value();
    Frame frame(test::test_session(), *scene_, options);
    budget_ = baseline_budget(test::test_session(), frame, camera_, 1);
    pathtracer::PathTracerOptions tracing;
    tracing.noise = 0.02;
    truth_ = traced_view(trace_paths(*scene_, scene_->lights_for(camera_),
                                     camera_view(camera_, kWidth, kHeight), tracing),
                         Show::indirect);
  }
  static void TearDownTestSuite() { view_.reset(), scene_.reset(); }

  static baselines::Irradiance run(Baseline baseline, unsigned samples, unsigned stride = 1,
                                   unsigned frames = 1) {
    std::map<std::string, double> settings;
    return run_baseline(baseline, *view_, view_->thinned(stride), budget_, samples, frames,
                        settings);
  }
  static Comparison errors(const baselines::Irradiance& irradiance) {
    return compare(traced_view(view_->with(irradiance), Show::indirect), "baseline", truth_,
                   "ground truth");
  }

  static inline std::unique_ptr<SceneData> scene_;
  static inline SceneCamera camera_;
  static inline std::unique_ptr<baselines::View> view_;
  static inline BaselineBudget budget_;
  static inline Image truth_;
};

// Tolerances: noise of ground truth and method, and what the method blurs: discs and texels of an
// RSM, cells of probes, and a third of this image's width by the filter.
TEST_F(Cornell, ConvergesToPathTracing) {
  struct Limit {
    Baseline baseline;
    unsigned samples;
    double nrmse, energy = 0.03;
  };
  // Radiance cascades replace rays that start behind a surface by others, often brighter ones.
  for (const auto& [baseline, samples, nrmse, energy] :
       {Limit{Baseline::paths, 512, 0.06}, Limit{Baseline::vpl, 4096, 0.12},
        Limit{Baseline::vpl_interleaved, 1024, 0.14}, Limit{Baseline::paths_filtered, 128, 0.4},
        Limit{Baseline::ddgi_first, 512, 0.25},
        Limit{Baseline::radiance_cascades, 64, 0.3, 0.08}}) {
    const Comparison many = errors(run(baseline, samples)), few = errors(run(baseline, 4));
    EXPECT_LT(many.nrmse_valid.value(), nrmse) << name_of(baseline);
    EXPECT_NEAR(many.energy_ratio.value(), 1, energy) << name_of(baseline);
    EXPECT_GT(few.nrmse_valid.value(), many.nrmse_valid.value()) << name_of(baseline);
  }
}

TEST_F(Cornell, BytesDoNotDependOnThreads) {
  const baselines::View one(*scene_, camera_, kWidth, kHeight, 1, 1);
  for (const Baseline baseline : values_of<Baseline>()) {
    std::map<std::string, double> settings;
    EXPECT_EQ(run_baseline(baseline, one, one, budget_, 3, 2, settings), run(baseline, 3, 1, 2))
        << name_of(baseline);
  }
}

TEST(BaselineFilter, DoesNotMixWallAndFloor) {
  SceneData scene = test::floor_scene(0.5f);
  test::add_quad(scene, {-10, 0, -1}, {20, 0, 0}, {0, 10, 0}, 0);
  scene.lights = {test::sun({0, -1, -1}, 1)};
  const SceneCamera camera = camera_at({0, 1, 2}, {0, -0.2f, -1});
  const baselines::View view(scene, camera, 32, 32, 1, 1);
  baselines::Irradiance image(view.hits().size());
  for (std::size_t i = 0; i < image.size(); ++i)
    image.set(i, glm::vec3(view.surfaces()[baselines::kNormal + 1][i] > 0.5f ? 1 : 0));
  const baselines::Irradiance filtered = baselines::wavelet_filter(view, image, 3);
  for (std::size_t i = 0; i < image.size(); ++i) EXPECT_FLOAT_EQ(filtered.at(i).x, image.at(i).x);
}

// A plane's irradiance that rises along a row is interpolated exactly.
TEST(BaselineFilter, InterpolatesBetweenThinnedPixels) {
  SceneData scene = test::floor_scene(0.5f);
  scene.lights = {test::sun({0, -1, 0}, 1)};
  SceneCamera camera;
  camera.eye = {0, 2, 0}, camera.forward = {0, -1, 0}, camera.up = {0, 0, -1};
  const baselines::View view(scene, camera, 32, 16, 1, 2), thin = view.thinned(4);
  baselines::Irradiance part(thin.hits().size());
  for (std::size_t i = 0; i < part.size(); ++i)
    part.set(i, glm::vec3(static_cast<float>(i % 8) * 4 + 2));
  const baselines::Irradiance image = baselines::upsampled(view, thin, part);
  for (std::size_t i = 0; i < image.size(); ++i)
    EXPECT_NEAR(image.at(i).x, std::clamp(static_cast<float>(i % 32), 2.0f, 30.0f), 1e-3f) << i;
}

// A closed room with a box, whose surfaces emit the same radiance: rays that end nowhere would lose
// light. Intervals end at walls and at the box, probes lie behind walls and in the box.
TEST(BaselineRadianceCascades, FurnaceIsEvenlyLit) {
  SceneData scene = test::furnace(0.5f, 2, 2);
  test::add_box(scene, {1.01f, 0.81f, 1.13f}, -0.7f, 0);
  const SceneCamera camera = camera_at({1, 1.5f, 1.8f}, {0, -0.6f, -1.5f});
  const baselines::View view(scene, camera, 16, 9, 1, 2);
  for (const auto& [cell, side, cascades] :
       {std::tuple{0.375f, 1u, 1u}, {0.375f, 1u, 4u}, {0.125f, 1u, 3u}, {0.375f, 2u, 2u}}) {
    const auto n = static_cast<std::uint32_t>(3 / cell);
    const ClpvGrid grid{{-0.513f, -0.507f, -0.491f}, cell, n, {1, 1, 1}};
    const baselines::CascadedImage image = baselines::radiance_cascades(
        view, {grid}, {.side = side, .first = 1, .cascades = cascades});
    for (std::size_t i = 0; i < image.irradiance.size(); ++i)
      EXPECT_NEAR(image.irradiance.at(i).x, 2 * pi_v<float>, 1e-3f * 2 * pi_v<float>)
          << i << " cells of " << cell << " m, " << cascades << " cascades";
  }
}

TEST(BaselineRejection, NamesWhatAMethodDoesNotHave) {
  const auto reason = [](Baseline baseline, const SceneData& scene, int bounces, Show show) {
    return test::error_of(ExitCode::usage,
                          [&] { require_baseline(baseline, scene, bounces, show); });
  };
  const SceneData lit = load_scene(scene_file("cornell.json")), glowing = test::furnace(0.5f, 2);
  EXPECT_THAT(reason(Baseline::vpl, glowing, 1, Show::indirect), HasSubstr("emissive"));
  EXPECT_THAT(reason(Baseline::ddgi_first, lit, 2, Show::indirect),
              HasSubstr("allowed: bounces 1"));
  EXPECT_THAT(reason(Baseline::radiance_cascades, lit, 2, Show::indirect),
              HasSubstr("allowed: bounces 1"));
  EXPECT_THAT(reason(Baseline::paths, lit, 1, Show::full),
              HasSubstr("found view 'full'; allowed: indirect, irradiance"));
  EXPECT_THAT(
      reason(Baseline::paths, load_scene(scene_file("cornell_fog.json")), 1, Show::indirect),
      HasSubstr("medium"));
  require_baseline(Baseline::paths, glowing, 0, Show::irradiance);
}

TEST(BaselineCommand, MeasuresBesideFrames) {
  const test::TemporaryFolder folder;
  const std::string cornell = scene_file("cornell.json").string();
  const std::string command =
      "quality " + cornell + " --cache " + (folder / "cache").string() +
      " --camera front --width 32 --height 18 --spp 64 --frames 1 --format json" +
      test::kSmallSweep;
  const test::Outcome outcome =
      test::run_here(command + " --bounces all --baseline paths,vpl --baseline-time 5 --images " +
                         (folder / "images").string() + " --output " + (folder / "a.json").string(),
                     ".", lab_additions());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json cells = nlohmann::json::parse(outcome.out)["cells"];
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0]["options"], nlohmann::json::object()) << "the frame itself";
  EXPECT_EQ(cells[1]["options"]["baseline"], "paths");
  EXPECT_EQ(cells[1]["rejected"], "");
  EXPECT_EQ(cells[1]["settings"]["budget_ms"], 5);
  EXPECT_GE(cells[1]["settings"]["paths_per_pixel"], 1);
  EXPECT_GE(cells[1]["settings"]["threads"], 1);
  EXPECT_GT(ms_of(cells[1]["times"], "baseline"), 0);
  EXPECT_GT(cells[1]["nrmse"], 0);
  EXPECT_THAT(cells[2]["rejected"].get<std::string>(), HasSubstr("more than one bounce"));
  EXPECT_EQ(read_image(folder / "images/paths/cornell-front.exr").width, 32);
  EXPECT_EQ(test::read_file((folder / "a.json").string()), outcome.out);

  const test::Outcome unknown =
      test::run_here(command + " --baseline nonsense", ".", lab_additions());
  EXPECT_EQ(unknown.exit_code, static_cast<int>(ExitCode::usage));
  EXPECT_THAT(unknown.err, HasSubstr("ddgi-first"));
}

// A camera's name once led --images to any file of the user.
TEST_F(QualityCommand, ASceneDoesNotChooseWhereImagesLie) {
  nlohmann::json room = nlohmann::json::parse(test::read_file(file("room.json")));
  room["cameras"][0]["name"] = "x/../../../victim";
  room["cameras"][1]["name"] = "..";
  std::ofstream(file("room.json")) << room.dump();
  std::ofstream(file("victim.exr")) << "of the user";
  const test::Outcome outcome =
      quality("--baseline paths --baseline-time 1 --images " + file("out") + " --format json",
              lab_additions());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(test::read_file(file("victim.exr")), "of the user");
  std::set<std::string> names;
  for (const auto& image : fs::recursive_directory_iterator(file("out")))
    names.insert(image.path().lexically_relative(file("out")));
  EXPECT_THAT(names, ElementsAre("paths", testing::MatchesRegex("paths/room-__-[0-9a-f]*.exr"),
                                 testing::MatchesRegex("paths/room-x_+victim-[0-9a-f]*.exr")));
}

}  // namespace clpv::baseline_test
