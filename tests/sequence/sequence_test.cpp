// SPDX-License-Identifier: MIT
// `clpv sequence`: its frames equal frames rendered alone, a run resumes where another ended, and
// ffmpeg writes films.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "image/image_io.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/frame/frame_lights.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/view.hpp"
#include "scene/load.hpp"
#include "sequence/stability.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::sequence_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSmall = " --width 48 --height 27 --rsm-size 64";
// Grids of other tests, whose programs these tests share.
const std::string kSwept = kSmallSweep,
                  kStepped =
                      " --grid 5 --transport sampled --gather all --blockers seen --cascades 1";

struct SequenceTest : ::testing::Test {
  TemporaryFolder folder;
  const fs::path scene = write_moving_scene(folder);

  fs::path frame(int i, const std::string& extension = "exr") const {
    return folder / fmt::format("out/frame-{:04}.{}", i, extension);
  }
  std::string method = kStepped;  ///< the fewest programs
  Outcome clpv(const std::string& arguments) const {
    return run_here(arguments + kSmall + method, folder.path());
  }
  Outcome sequence(const std::string& arguments) const {
    return clpv("sequence moving.json -o out " + arguments);
  }
  json written(const std::string& file) const {
    return json::parse(read_file(folder / ("out/" + file)));
  }
  const fs::path times = folder / "out/times.jsonl";
  /// The whole lines of times.jsonl that have this member.
  std::vector<json> lines(const std::string& member) const {
    std::vector<json> found;
    std::istringstream text(read_file(times));
    for (std::string line; std::getline(text, line);)
      if (json each = json::parse(line, nullptr, false); each.is_object() && each.contains(member))
        found.push_back(each);
    return found;
  }
  json summary() const { return lines("summary").back()["summary"]; }

  /// A folder with an ffmpeg that copies its input and arguments to its output.
  std::string fake_ffmpeg(const std::string& script) const {
    const fs::path path = folder.write("bin/ffmpeg", "#!/bin/sh\n" + script);
    fs::permissions(path, fs::perms::owner_all);
    return path.parent_path().string() + ":/usr/bin:/bin";
  }
};

TEST_F(SequenceTest, EveryFrameIsTheOneRenderedAlone) {
  // The camera crosses cells of 0.25 m; a wall, a sun and a lamp move.
  method = kSwept;
  const Outcome outcome = sequence("--frames 3 --fps 3 --from 0.1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(
        clpv(fmt::format("render moving.json -o alone.exr --time {}", 0.1 + i / 3.0)).exit_code, 0);
    const Image image = read_image(folder / "alone.exr"), of_sequence = read_image(frame(i));
    EXPECT_EQ(of_sequence.pixels, image.pixels) << i;
    EXPECT_EQ(of_sequence.metadata.at("time"), image.metadata.at("time"));
  }
  EXPECT_NE(read_image(frame(0)).pixels, read_image(frame(1)).pixels) << "something moves";
}

TEST_F(SequenceTest, ARunResumesWhereAnotherEnded) {
  ASSERT_EQ(sequence("--frames 3 --fps 10").exit_code, 0);
  const std::string second = read_file(frame(1));
  const auto time = fs::last_write_time(frame(0));
  fs::remove(frame(1));
  folder.write("out/frame-0002.exr", read_file(frame(2)).substr(0, 300));
  const Outcome again = sequence("--frames 4 --fps 10");
  ASSERT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, AllOf(HasSubstr("1 of 4 frames existed"), HasSubstr("frame-0002.exr"),
                               HasSubstr("rendered again"), HasSubstr("3 frames in")));
  EXPECT_EQ(fs::last_write_time(frame(0)), time) << "not rendered again";
  EXPECT_EQ(read_file(frame(1)), second) << "the same bytes";
  const std::vector<json> frames = lines("frame");
  ASSERT_EQ(frames.size(), 6u);
  EXPECT_EQ(frames[5]["frame"], 3);
  EXPECT_DOUBLE_EQ(frames[5]["time"].get<double>(), 0.3);
  EXPECT_EQ(summary()["frames"], 4) << "existing frames keep their times";
  EXPECT_EQ(summary()["steady"], 2) << "the first frame of each run aside";
}

TEST_F(SequenceTest, InvalidLinesOfTimesAreSkipped) {
  ASSERT_EQ(sequence("--frames 3 --fps 10").exit_code, 0);
  const json before = summary(), line = lines("frame")[1];
  std::string text;
  for (const auto& [member, value] :
       {std::pair<std::string, json>{"frame", -5},
        {"frame", 0.5},
        {"frame", 3},
        {"frame", 1e30},
        {"key", "another"},
        {"settings", "another"},
        {"frame_ms", -1},
        {"frame_ms", "1"},
        {"first", 1},
        {"stages", {{{"stage", "none"}, {"ms", 1}, {"timer", "event"}}}}}) {
    json bad = line;
    bad["frame_ms"] = 1e6;
    bad[member] = value;
    text += bad.dump() + "\n";
  }
  text += std::string(2 << 20, '[') + "\nnull\n" + line.dump().substr(0, 99);  // the last is torn
  folder.write("out/times.jsonl", read_file(times) + text);
  ASSERT_EQ(sequence("--frames 3 --fps 10").exit_code, 0);
  EXPECT_EQ(summary(), before);
}

TEST_F(SequenceTest, FilesOfOthersAreNamedBeforeTheWorkAndStay) {
  const auto refused = [&](const fs::path& file, const std::string& why) {
    const Outcome outcome = sequence("--frames 3 --fps 10 --stability");
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.err, HasSubstr(file.filename().string() + ": " + why));
    EXPECT_FALSE(fs::exists(frame(0)));
  };
  folder.write("mine", "my diary");
  for (const fs::path& file : {frame(1), times, folder / "out/stability.json"}) {
    for (const char* target : {"../mine", "../none"}) {
      fs::create_directories(file.parent_path());
      fs::create_symlink(target, file);
      refused(file, "cannot be written: it is a symb");
      EXPECT_EQ(read_file(folder / "mine"), "my diary");
      EXPECT_FALSE(fs::exists(folder / "none"));
      fs::remove(file);
    }
  }
  for (const fs::path& file : {frame(1), times}) {
    for (const std::string text : {"{\"mine\": 1}\n", "x"}) {
      folder.write(fs::relative(file, folder.path()).string(), text);
      refused(file, "found a file that clpv did not write");
      EXPECT_EQ(read_file(file), text);
    }
    fs::remove(file);
  }
  fs::create_directory(frame(2));
  refused(frame(2), "cannot be written: it is a folder");
  fs::remove(frame(2));
  folder.write("out/times.json", "mine");
  ASSERT_EQ(sequence("--frames 1 --fps 10").exit_code, 0);
  EXPECT_EQ(read_file(folder / "out/times.json"), "mine");
}

TEST_F(SequenceTest, FramesAreKnownByTheirPixels) {
  for (const std::string extension : {"exr", "png"}) {
    const std::string run = "--frames 2 --fps 10 --format " + extension;
    ASSERT_EQ(sequence(run).exit_code, 0);
    ASSERT_THAT(sequence(run).err, HasSubstr("2 of 2 frames existed"));
    const fs::path file = frame(1, extension);
    const std::string whole = read_file(file);
    Image edited = read_image(file);  // with its metadata
    edited.pixels[0] += 0.5f;
    if (extension == "exr")
      write_exr(file, edited);
    else
      write_png(file, edited);
    Outcome again = sequence(run);
    EXPECT_THAT(again.err, AllOf(HasSubstr("1 of 2"), HasSubstr("its pixels were changed")));
    EXPECT_TRUE(read_file(file) == whole);
    std::string damaged = whole;
    for (std::size_t i = damaged.size() - 60; i < damaged.size() - 20; ++i) damaged[i] ^= 0x55;
    folder.write(fs::relative(file, folder.path()).string(), damaged);
    again = sequence(run);
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_THAT(again.err, AllOf(HasSubstr("1 of 2"), HasSubstr("rendered again")));
    EXPECT_TRUE(read_file(file) == whole);
  }
}

TEST_F(SequenceTest, FramesOfOtherInputsAreRenderedAgain) {
  ASSERT_EQ(sequence("--frames 2 --fps 10 --format png").exit_code, 0);
  for (const std::string other : {"--fps 5", "--fps 10 --from 3", "--fps 10 --iterations 3",
                                  "--fps 10 --exposure 1", "--fps 10 --view albedo"}) {
    const std::string before = read_file(frame(1, "png"));
    const Outcome outcome = sequence("--frames 2 --format png " + other);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.err, Not(HasSubstr("2 of 2"))) << other;
    EXPECT_NE(read_file(frame(1, "png")), before) << other;
  }
  const std::string set = "--frames 2 --fps 10 --format png --centres set.json";
  folder.write("set.json", R"({"centres": [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0]]})");
  ASSERT_EQ(sequence(set).exit_code, 0);
  folder.write("set.json", R"({"centres": [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, -1, 0]]})");
  EXPECT_THAT(sequence(set).err, Not(HasSubstr("frames existed"))) << "other centres";
  std::string text = read_file(scene);
  text.replace(text.find("\"illuminance_lux\": 10"), 21, "\"illuminance_lux\": 11");
  folder.write("moving.json", text);
  EXPECT_THAT(sequence("--frames 2 --fps 10 --format png --view albedo").err,
              Not(HasSubstr("frames existed")))
      << "the scene file says something else";
}

TEST_F(SequenceTest, TimesOfEveryStageAreSummedUp) {
  ASSERT_EQ(sequence("--frames 4 --fps 10").exit_code, 0);
  const std::vector<json> frames = lines("frame");
  const json times = summary();
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(times["fps"], 10);
  EXPECT_EQ(times["options"]["grid"], 5);
  EXPECT_TRUE(frames[0]["first"].get<bool>());
  ASSERT_EQ(times["steady"], 3);
  const std::vector<std::string> whole = {"pose", "frame", "write"};
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(times["times"][i]["stage"], whole[i]);
  const std::vector<json> stages(times["times"].begin() + 3, times["times"].end());
  ASSERT_EQ(stages.size(), frames[1]["stages"].size());
  for (std::size_t s = 0; s < stages.size(); ++s) {
    std::vector<double> ms;
    for (int i = 1; i < 4; ++i) ms.push_back(frames[i]["stages"][s]["ms"]);
    std::ranges::sort(ms);
    EXPECT_EQ(stages[s]["stage"], frames[1]["stages"][s]["stage"]);
    EXPECT_EQ(stages[s]["n"], 3);
    EXPECT_DOUBLE_EQ(stages[s]["median"].get<double>(), ms[1]) << stages[s];
  }
}

TEST_F(SequenceTest, AFilmHasEveryFrame) {
  {
    const Variable path(
        "PATH", fake_ffmpeg("for last; do :; done; { echo \"$@\"; wc -c; } > \"${last#file:}\"\n"));
    ASSERT_EQ(sequence("--frames 3 --fps 12.5 --video film.mp4").exit_code, 0);
  }
  EXPECT_THAT(read_file(folder / "film.mp4"), AllOf(HasSubstr("-video_size 48x27 -framerate 12.5"),
                                                    HasSubstr(std::to_string(3 * 48 * 27 * 3))));
  const Variable path("PATH", fake_ffmpeg("[ $1 = -version ] || { echo no codec >&2; exit 9; }\n"));
  const Outcome failing = sequence("--frames 3 --fps 12.5 --video other.mp4");
  EXPECT_EQ(failing.exit_code, 1);
  EXPECT_THAT(failing.err,
              AllOf(HasSubstr("other.mp4"), HasSubstr("ended with 9"), HasSubstr("no codec")));
  EXPECT_FALSE(fs::exists(folder / "other.mp4"));
}

TEST_F(SequenceTest, AMissingFfmpegIsReportedBeforeTheWork) {
  const Variable path("PATH", "/nowhere");
  const Outcome outcome = sequence("--frames 3 --fps 25 --video film.mp4");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              HasSubstr("--video needs ffmpeg, which is not in PATH (Debian: ffmpeg)"));
  EXPECT_FALSE(fs::exists(frame(0).parent_path()));
  const Variable found("PATH", fake_ffmpeg("exit 0\n"));
  EXPECT_THAT(sequence("--frames 3 --fps 25 --video none/film.mp4").err, HasSubstr("no folder"));
  EXPECT_FALSE(fs::exists(frame(0).parent_path())) << "an empty folder";
}

TEST_F(SequenceTest, StabilityCoversAllFramesButTheFirst) {
  method = kSwept;
  ASSERT_EQ(sequence("--frames 3 --fps 10 --stability --traced 4").exit_code, 0);
  const json stability = written("stability.json");
  EXPECT_EQ(stability["schema"], 1);
  EXPECT_EQ(stability["options"]["grid"], 16);
  ASSERT_EQ(stability["frames"].size(), 2u);
  for (const json& frame : stability["frames"]) {
    EXPECT_FALSE(frame["still"].get<bool>()) << "a sun moves";
    EXPECT_GT(frame["change"].get<double>(), 0);
    EXPECT_GT(frame["seen"].get<double>(), 0.3);
    EXPECT_LE(frame["seen"].get<double>(), 1);
    EXPECT_GT(frame["traced"].get<double>(), 0);
  }
  EXPECT_TRUE(stability["summary"]["across_cells"].is_null()) << "no cascade moved";
  EXPECT_THAT(stability["note"].get<std::string>(), HasSubstr("no two successive frames"));
}

TEST_F(SequenceTest, AStaticSceneIsReported) {
  GltfBuilder still;
  still.triangle();
  still.finish("still.bin");
  folder.write("still.bin", still.binary);
  folder.write("still.gltf", still.document.dump());
  const Outcome outcome = clpv("sequence still.gltf -o out --frames 2 --fps 1");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("nothing moves"));
  EXPECT_EQ(read_image(frame(0)).pixels, read_image(frame(1)).pixels);
}

// Stability of light (sequence/stability.hpp): closed cases of the measure, and frames of a moving
// camera.

constexpr int kWidth = 64, kHeight = 36;

/// G-buffer of the floor y = 0 and, where `box` > 0, of a box's top at that height over |x|, |z| <
/// 1.
SurfaceImage view_of_floor(const glm::vec3& eye, double box = 0) {
  SurfaceImage image;
  image.view = camera_view(test::camera_at(eye, {0.1f, -0.6f, -1}), kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec3 far = reference::surface_position(image.view, x, y, 1), from(eye);
      const auto meets = [&](double height) { return (height - from.y) / (far.y - from.y); };
      double depth = meets(0);
      const glm::dvec3 on_top = from + meets(box) * (far - from);
      if (box > 0 && std::abs(on_top.x) < 1 && std::abs(on_top.z) < 1) depth = meets(box);
      image.depth.push_back(depth > 0 ? static_cast<float>(depth) : 0.0f);
      image.normal.push_back(depth > 0 ? glm::vec4(0, 1, 0, 0) : glm::vec4(0));
    }
  }
  return image;
}

std::size_t count(const std::vector<bool>& counted) {
  return static_cast<std::size_t>(std::count(counted.begin(), counted.end(), true));
}

TEST(Stability, APlaneIsComparedWhereBothViewsShowIt) {
  const SurfaceImage here = view_of_floor({0, 2, 3});
  const std::size_t all = count(still_seen(here, here));
  EXPECT_EQ(all, static_cast<std::size_t>(kWidth * kHeight));
  const std::vector<bool> aside = still_seen(here, view_of_floor({0.37f, 2.05f, 2.9f}));
  EXPECT_LT(count(aside), all) << "what left the view";
  EXPECT_GT(count(aside), all * 7 / 10);
  EXPECT_EQ(count(still_seen(here, view_of_floor({5000, 2, 3}))), 0u);
}

TEST(Stability, MovedAndHiddenSurfacesAreNotCompared) {
  const SurfaceImage with = view_of_floor({0, 2, 3}, 0.3), without = view_of_floor({0.1f, 2, 3});
  const std::vector<bool> seen = still_seen(with, without);
  std::size_t on_box = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const glm::dvec3 p =
        reference::surface_position(with.view, static_cast<double>(i % kWidth),
                                    static_cast<double>(i / kWidth), double{with.depth[i]});
    on_box += p.y > 0.1;
    EXPECT_FALSE(seen[i] && p.y > 0.1) << i;
  }
  EXPECT_GT(on_box, 100u);
  EXPECT_GT(count(seen), (seen.size() - on_box) * 8 / 10) << "the floor round it";
  SurfaceImage turned = without;
  for (glm::vec4& normal : turned.normal) normal = {1, 0, 0, 0};
  EXPECT_EQ(count(still_seen(without, turned)), 0u);
}

TEST(Stability, ClosedCases) {
  std::vector<float> light(std::size_t{4} * kWidth * kHeight, 0.5f), brighter;
  for (std::size_t i = 0; i < light.size(); i += 3) light[i] = 0.125f * static_cast<float>(i % 7);
  for (const float value : light) brighter.push_back(value * 1.25f);
  const std::vector<bool> all(std::size_t{kWidth} * kHeight, true);
  const LightChange none = change_of_light(all, light, light);
  EXPECT_EQ(none.points, all.size());
  EXPECT_EQ(none.mean, 0.0);
  EXPECT_EQ(none.p95, 0.0);
  EXPECT_DOUBLE_EQ(change_of_light(all, light, brighter).mean.value(), 0.25);
  // A camera that moves over a floor under even light.
  const std::vector<float> even(light.size(), 0.75f);
  EXPECT_EQ(
      change_of_light(still_seen(view_of_floor({0, 2, 3}), view_of_floor({0.2f, 2, 3})), even, even)
          .mean,
      0.0);
  // 4 of 100 points change by 100 %: 4 % of the light, and too few for the 95th percentile.
  std::vector<float> few(400, 1.0f), flashed = few;
  for (std::size_t i = 0; i < 16; ++i) flashed[i] = 2;
  const LightChange flash = change_of_light(std::vector<bool>(100, true), few, flashed);
  EXPECT_DOUBLE_EQ(flash.mean.value(), 0.04);
  EXPECT_EQ(flash.p95, 0.0);
  EXPECT_DOUBLE_EQ(change_of_light(std::vector<bool>(4, true), few, flashed).p95.value(), 1.0);
}

TEST(Stability, DarknessAndNothingHaveNoShare) {
  const std::vector<float> dark(8, 0.0f), lit(8, 1.0f);
  EXPECT_FALSE(change_of_light({true, true}, dark, lit).mean);
  EXPECT_FALSE(change_of_light({false, false}, lit, lit).mean);
  EXPECT_EQ(change_of_light({false, true}, lit, lit).points, 1u);
}

/// The Cornell box, by a camera that moves.
struct SteadyFrame : ::testing::Test {
  static RenderOptions small_options() {
    RenderOptions options = test::small_sweep();
    options.width = 48, options.height = 27, options.cascade_size = 1.5;
    options.rsm_size = 64, options.shadow_size = 64, options.near = Near::off;
    return options;
  }
  static constexpr float kCell = 1.5f / 16;

  void SetUp() override { camera_.eye = (glm::floor(camera_.eye / kCell) + 0.25f) * kCell; }

  /// Moves the camera by that many cells, and returns the change of light on surfaces visible
  /// before and after.
  LightChange after(float cells) {
    if (before_.depth.empty()) render();
    camera_.eye.x += cells * kCell;
    const SurfaceImage seen = before_;
    const std::vector<float> irradiance = irradiance_;
    render();
    return change_of_light(still_seen(seen, before_), irradiance, frame_.irradiance_on(seen));
  }
  void render() {
    frame_.render(camera_);
    before_ = read_surface(test_session(), frame_.seen());
    irradiance_ = frame_.read(Show::irradiance);
  }

  SceneData scene_ = load_scene(test::scene_file("cornell.json"));
  SceneCamera camera_ = scene_.camera("");
  Frame frame_{test_session(), scene_, small_options()};
  SurfaceImage before_;
  std::vector<float> irradiance_;
};

TEST_F(SteadyFrame, LightChangesLittleAsTheEyeMovesAndAsMuchAsTheLight) {
  EXPECT_EQ(after(0).mean, 0.0);
  const LightChange inside = after(0.5f);
  EXPECT_LT(inside.mean.value(), 0.02) << "cascades hand over elsewhere";
  EXPECT_GT(inside.points, std::size_t{48 * 27 / 2});
  const double across = after(1).mean.value();
  EXPECT_GT(across, 0.0) << "another cell";
  EXPECT_LT(across, 0.08);
  for (SceneLight& light : scene_.lights) light.data = scaled(light.data, 1.25f);
  EXPECT_NEAR(after(0).mean.value(), 0.25, 1e-3) << "halves round";
}

}  // namespace
}  // namespace clpv::test::sequence_test
