// SPDX-License-Identifier: MIT
// Presets: what they set, what overrides them, and that results tell what was resolved.
#include "options/presets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "image/image_io.hpp"
#include "options/render_options.hpp"
#include "support/error.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::presets_test {
namespace {

using ::testing::HasSubstr;

TEST(Presets, BestIsTheDefaults) {
  RenderOptions options;
  set_option(options, "preset", "best");
  EXPECT_EQ(to_json(options), to_json(RenderOptions{}));
  EXPECT_EQ(to_json(options)["preset"], "best");
}

TEST(Presets, PaperIsThePublishedScheme) {
  RenderOptions options;
  set_option(options, "preset", "paper");
  const nlohmann::json found = to_json(options),
                       published = {
                           {"preset", "paper"},       {"basis", "srbf8v2"},      {"lambda", 0.25},
                           {"lobe", "rotate"},        {"lobe-time", "kernel"},   {"evaluate", "table"},
                           {"table-size", 256},       {"table", "image"},        {"transport", "sampled"},
                           {"state", "coefficients"}, {"layout", "image"},       {"storage", "half"},
                           {"rsm-format", "paper"},   {"blocking", "one-sided"}, {"blockers", "seen"},
                           {"gather", "all"},         {"gather-offset", 0.5}};
  for (const auto& [name, value] : published.items()) EXPECT_EQ(found[name], value) << name;
}

TEST(Presets, LeaveAloneWhatTheyDoNotSet) {
  RenderOptions options;
  set_option(options, "width", "77");
  set_option(options, "cascade-size", "3.5");
  set_option(options, "preset", "paper");
  set_option(options, "preset", "best");
  nlohmann::json expected = to_json(RenderOptions{});
  expected["width"] = 77;
  expected["cascade-size"] = 3.5;
  EXPECT_EQ(to_json(options), expected) << "best undoes all that paper set";
}

TEST(Presets, RenderRecordsWhatWasResolved) {
  const test::TemporaryFolder folder;
  const std::string image = (folder.path() / "a.exr").string(), stats = (folder.path() / "a.json").string();
  // The preset comes last, and is overridden all the same; the scene's own cascades stand.
  const test::Outcome outcome =
      test::run_here("render " CLPV_SOURCE_DIR "/scenes/cornell.json -o " + image + " --stats " + stats +
                     " --basis sh2 --width 16 --height 9 --grid 8 --preset paper");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json options = nlohmann::json::parse(test::read_file(stats)).at("options");
  EXPECT_EQ(options["preset"], "paper");
  EXPECT_EQ(options["basis"], "sh2");
  EXPECT_EQ(options["transport"], "sampled");
  EXPECT_EQ(options["cascade-size"], 2.0);
  const auto metadata = read_image(image).metadata;
  EXPECT_EQ(metadata.at("preset"), "paper");
  EXPECT_EQ(metadata.at("basis"), "sh2");
  EXPECT_EQ(metadata.at("blocking"), "one-sided");
}

TEST(Presets, PropagateTakesThem) {
  const std::string propagate = "propagate --grid 5 --iterations 1 --at 2,2,2 ";
  const test::Outcome paper = test::run_here(propagate + "--lambda 0.3 --preset paper");
  ASSERT_EQ(paper.exit_code, 0) << paper.err;
  const nlohmann::json options = nlohmann::json::parse(paper.out).at("options");
  EXPECT_EQ(options["preset"], "paper");
  EXPECT_EQ(options["basis"], "srbf8v2");
  EXPECT_EQ(options["lambda"], 0.3);
  const test::Outcome swept = test::run_here(propagate + "--preset best");
  EXPECT_EQ(swept.exit_code, 2);
  EXPECT_THAT(swept.err, HasSubstr("transport: found 'sweep', which takes no steps"));
}

TEST(Presets, QualityTakesAPresetsTransport) {
  const test::TemporaryFolder folder;
  const test::Outcome outcome = test::run_here(
      "quality " CLPV_SOURCE_DIR
      "/scenes/cornell.json --camera red --vary preset=paper,best --basis sh2 --width 16 --height 9 --grid 8 "
      "--spp 1 --frames 1 --format json --cache " +
      folder.path().string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json cells = nlohmann::json::parse(outcome.out).at("cells");
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_NE(cells[0]["nrmse"], cells[1]["nrmse"]);
}

TEST(Presets, HelpStatesThem) {
  const test::Outcome outcome = test::run_here("render --help");
  EXPECT_THAT(outcome.out, HasSubstr("paper: the published scheme --basis srbf8v2"));
}

}  // namespace
}  // namespace clpv::presets_test
