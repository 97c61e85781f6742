// SPDX-License-Identifier: MIT
// Options of a frame: conversion from text to a value and back, errors for invalid values, presets,
// and a name for each value of each enumeration.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tuple>

#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "options/render_options.hpp"
#include "options/show.hpp"
#include "options/stage_options.hpp"
#include "options/stages.hpp"
#include "scene/scene.hpp"
#include "scene/sky.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_here.hpp"
#include "times/time_record.hpp"

namespace clpv::options_test {
using ::testing::HasSubstr;

std::string value_of(const RenderOptions& options, const std::string& name) {
  for (const OptionDescription& info : list_options(options)) {
    if (info.name == name) return info.value;
  }
  return "not listed";
}

std::vector<std::string> choices_in(const std::string& allowed) {
  std::vector<std::string> choices;
  std::istringstream words(allowed);
  for (std::string word; std::getline(words, word, '|');) choices.push_back(word);
  return choices;
}

TEST(Options, EachConvertsFromTextToValueAndBack) {
  const std::map<std::string, std::string> numbers_and_files = {
      {"centres", "mine.json"}, {"lambda", "0.375"},     {"table-size", "99"},
      {"iterations", "3"},      {"grid", "17"},          {"cascades", "2"},
      {"cascade-size", "6.25"}, {"rsm-size", "64"},      {"shadow-size", "128"},
      {"width", "31"},          {"blocker-stride", "2"}, {"height", "17"},
      {"gather-offset", "1.5"}, {"bounce-sweeps", "5"}};
  for (const OptionDescription& info : list_options(RenderOptions{})) {
    SCOPED_TRACE(info.name);
    const bool choice = info.allowed.find('|') != std::string::npos;
    std::set<std::string> seen;
    for (const std::string& text :
         choice ? choices_in(info.allowed)
                : std::vector<std::string>{numbers_and_files.at(info.name)}) {
      RenderOptions options;
      set_option(options, info.name, text);
      EXPECT_EQ(value_of(options, info.name), text);
      EXPECT_TRUE(seen.insert(to_json(options).at(info.name).dump()).second)
          << text << " is like another";
    }
    EXPECT_GE(seen.size(), choice ? 2u : 1u);
  }
}

TEST(Options, InvalidValuesAreRejectedWithTheAllowedOnes) {
  for (const OptionDescription& info : list_options(RenderOptions{})) {
    SCOPED_TRACE(info.name);
    for (const std::string& bad : {info.value + "x", std::string()}) {
      if (info.name == "centres" && !bad.empty()) continue;  // any text may name a file
      RenderOptions options;
      EXPECT_EQ(test::error_of(ExitCode::usage, [&] { set_option(options, info.name, bad); }),
                info.name + ": found '" + bad + "', allowed: " + info.allowed);
      EXPECT_EQ(to_json(options), to_json(RenderOptions{})) << "changed all the same";
    }
  }
  RenderOptions options;
  EXPECT_THROW(set_option(options, "colour", "red"), Error);
}

TEST(Options, ABasisReplacesAFileOfCentres) {
  RenderOptions options;
  set_option(options, "centres", "mine.json");
  set_option(options, "basis", "sh2");
  EXPECT_EQ(options.centres, "");
}

TEST(Options, ContradictionsAreRejectedByTheFirstOption) {
  SceneData plain, under_a_sky, in_fog;
  under_a_sky.sky = std::make_shared<const Sky>(constant_sky(glm::vec3(1)));
  in_fog.medium.emplace();
  const auto rejected = [](const std::string& option, const SceneData& scene, const auto& change) {
    RenderOptions options;
    change(options);
    EXPECT_THAT(test::error_of(ExitCode::usage, [&] { validate(options, scene); }),
                ::testing::StartsWith(option + ": found"));
  };
  const auto steps = [](RenderOptions& o) { o.transport = TransportKind::sampled; };
  for (const SceneData* scene : {&plain, &under_a_sky, &in_fog})
    EXPECT_NO_THROW(validate({}, *scene));
  rejected("blocking", plain, [](RenderOptions& o) { o.blocking = Blocking::one_sided; });
  rejected("lobe-time", plain, [](RenderOptions& o) { o.lobe_time = LobeTime::kernel; });
  rejected("bounces", plain, [&](RenderOptions& o) { steps(o), o.bounces = Bounces::two; });
  rejected("near", plain, [&](RenderOptions& o) { steps(o), o.near = Near::traced; });
  rejected("transport", under_a_sky, steps);
  rejected("transport", in_fog, steps);
}

/// Those that are no options, which the tests above go through.
template <typename E>
class EachNamedEnum : public ::testing::Test {};
using NamedEnums = ::testing::Types<Show, ToneMap, LightKind, Stage, Pass>;
TYPED_TEST_SUITE(EachNamedEnum, NamedEnums);

TYPED_TEST(EachNamedEnum, HasAUniqueNameForEachValue) {
  const auto values = values_of<TypeParam>();
  ASSERT_GE(values.size(), 2u);
  std::set<std::string> names;
  for (const TypeParam value : values) {
    EXPECT_TRUE(names.insert(std::string(name_of(value))).second) << name_of(value);
    EXPECT_EQ(named<TypeParam>("it", name_of(value)), value);
  }
  EXPECT_EQ(name_of(static_cast<TypeParam>(values.size())), "");
}

using ::testing::HasSubstr;

TEST(Presets, KeepOptionsThatTheyDoNotSet) {
  RenderOptions options;
  set_option(options, "shadow-size", "77");
  set_option(options, "preset", "paper");
  set_option(options, "preset", "best");
  nlohmann::json expected = to_json(RenderOptions{});
  expected["shadow-size"] = 77;
  EXPECT_EQ(to_json(options), expected) << "best undoes all that paper set";
}

TEST(Presets, FastHasNoNearFieldAndFineMoreRays) {
  RenderOptions options;
  EXPECT_TRUE(options.traces_near());
  set_option(options, "preset", "fast");
  EXPECT_FALSE(options.traces_near());
  set_option(options, "preset", "fine");
  EXPECT_TRUE(options.traces_near());
  EXPECT_EQ(near_options(options).rays, 16);
  set_option(options, "transport", "sampled");
  EXPECT_FALSE(options.traces_near()) << "auto: off without a sweep";
}

TEST(Options, BouncesAreAllWithASweepElseOne) {
  for (const auto& [transport, bounces] :
       {std::pair{"sweep", Bounces::all}, {"sampled", Bounces::one}})
    EXPECT_EQ(resolve_options({{"transport", transport}}, SceneData{}).bounces, bounces);
  EXPECT_EQ(resolve_options({{"preset", "paper"}}, SceneData{}).bounces, Bounces::one);
  EXPECT_EQ(resolve_options({{"bounces", "1"}}, SceneData{}).bounces, Bounces::one);
}

TEST(Options, NearPixelsAreAboutAsManyAtEachSizeOfImage) {
  RenderOptions options;
  const std::map<std::pair<int, int>, int> steps = {
      {{16, 9}, 1},     {{240, 135}, 1},   {{480, 270}, 2},  {{960, 540}, 4},
      {{1280, 720}, 4}, {{1920, 1080}, 8}, {{3840, 2160}, 8}};
  for (const auto& [size, step] : steps) {
    std::tie(options.width, options.height) = size;
    options.near_size = NearSize::automatic;
    EXPECT_EQ(near_options(options).step, step) << size.first;
    options.near_size = NearSize::quarter;
    EXPECT_EQ(near_options(options).step, 4);
  }
}

TEST(Presets, RenderRecordsWhatWasResolved) {
  const test::TemporaryFolder folder;
  const std::string image = (folder.path() / "a.exr").string(),
                    stats = (folder.path() / "a.json").string();
  // Options override the preset wherever it stands; the scene's cascades override its sizes.
  const test::Outcome outcome = test::must_run_here(
      "render " CLPV_SOURCE_DIR "/scenes/cornell.json -o " + image + " --stats " + stats +
      " --basis sh2 --width 16 --height 9 --grid 16 --preset paper");
  const nlohmann::json report = nlohmann::json::parse(test::read_file(stats));
  const nlohmann::json& options = report.at("options");
  EXPECT_GT(report.at("launches"), 20);
  EXPECT_GE(report.at("waits"), 1);
  const std::vector<TimeRecord> times = report.at("times");
  EXPECT_GT(ms_of(times, "host"), 0);
  EXPECT_LT(ms_of(times, "host"), ms_of(times, "frame"));
  double launches = 0;
  for (const nlohmann::json& kernel : report.at("kernels"))
    launches += kernel.at("launches").get<double>();
  EXPECT_EQ(launches, report.at("launches")) << "each launch belongs to a stage";
  EXPECT_EQ(options["preset"], "paper");
  EXPECT_EQ(options["basis"], "sh2");
  EXPECT_EQ(options["transport"], "sampled");
  EXPECT_EQ(options["near"], "off");
  EXPECT_EQ(options["cascade-size"], 2.0);
  const auto metadata = read_image(image).metadata;
  EXPECT_EQ(metadata.at("preset"), "paper");
  EXPECT_EQ(metadata.at("basis"), "sh2");
  EXPECT_EQ(metadata.at("blocking"), "one-sided");
}

TEST(Presets, QualityTakesAPresetsTransport) {
  const test::TemporaryFolder folder;
  const test::Outcome outcome = test::must_run_here(
      "quality " CLPV_SOURCE_DIR
      "/scenes/cornell.json --camera red --vary preset=paper,best --basis sh2 "
      "--width 16 --height 9 --grid 16 --spp 1 --frames 1 --format json --cache " +
      folder.path().string());
  const nlohmann::json cells = nlohmann::json::parse(outcome.out).at("cells");
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_NE(cells[0]["nrmse"], cells[1]["nrmse"]);
}

}  // namespace clpv::options_test
