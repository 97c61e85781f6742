// SPDX-License-Identifier: MIT
// Presets: what they set, what overrides them, and that results tell what was resolved.
#include "options/presets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "image/image_io.hpp"
#include "options/render_options.hpp"
#include "support/error.hpp"
#include "tests/support/run_program.hpp"

namespace clpv {
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
  const nlohmann::json json = to_json(options);
  EXPECT_EQ(json["preset"], "paper");
  EXPECT_EQ(json["basis"], "srbf8v2");
  EXPECT_EQ(json["lambda"], 0.25);
  EXPECT_EQ(json["lobe"], "rotate");
  EXPECT_EQ(json["lobe-time"], "kernel");
  EXPECT_EQ(json["evaluate"], "table");
  EXPECT_EQ(json["table-size"], 256);
  EXPECT_EQ(json["table"], "image");
  EXPECT_EQ(json["transport"], "sampled");
  EXPECT_EQ(json["state"], "coefficients");
  EXPECT_EQ(json["layout"], "image");
  EXPECT_EQ(json["storage"], "half");
  EXPECT_EQ(json["rsm-format"], "paper");
  EXPECT_EQ(json["blocking"], "one-sided");
  EXPECT_EQ(json["blockers"], "seen");
  EXPECT_EQ(json["gather"], "all");
  EXPECT_EQ(json["gather-offset"], 0.5);
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

TEST(Presets, RefusesUnknownNames) {
  RenderOptions options;
  try {
    set_option(options, "preset", "worst");
    ADD_FAILURE() << "taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_STREQ(error.what(), "preset: found 'worst', allowed: best|paper");
  }
}

TEST(Presets, RenderRecordsWhatWasResolved) {
  const test::TemporaryFolder folder;
  const std::string image = (folder.path() / "a.exr").string(), stats = (folder.path() / "a.json").string();
  // The preset comes last, and is overridden all the same; the scene's own cascades stand.
  const test::Outcome outcome =
      test::run(std::string(CLPV_PROGRAM) + " render " + CLPV_SOURCE_DIR + "/scenes/cornell.json -o " +
                image + " --stats " + stats + " --basis sh2 --width 16 --height 9 --grid 8 --preset paper");
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
  const auto options = [](const std::string& given) {
    const test::Outcome outcome =
        test::run(std::string(CLPV_PROGRAM) + " propagate --grid 5 --iterations 1 --at 2,2,2 " + given);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out).at("options");
  };
  EXPECT_EQ(options("")["preset"], nullptr);
  const nlohmann::json paper = options("--lambda 0.3 --preset paper");
  EXPECT_EQ(paper["preset"], "paper");
  EXPECT_EQ(paper["basis"], "srbf8v2");
  EXPECT_EQ(paper["lambda"], 0.3);
  const nlohmann::json best = options("--preset best --transport exact");
  EXPECT_EQ(best["basis"], RenderOptions{}.basis);
  EXPECT_EQ(best["transport"], "exact");
  const test::Outcome swept = test::run(std::string(CLPV_PROGRAM) + " propagate --at 0,0,0 --preset best");
  EXPECT_EQ(swept.exit_code, 2);
  EXPECT_THAT(swept.err, HasSubstr("transport: found 'sweep', which takes no steps"));
}

TEST(Presets, QualityTakesAPresetsTransport) {
  const test::TemporaryFolder folder;
  const test::Outcome outcome = test::run(
      std::string(CLPV_PROGRAM) + " quality " + CLPV_SOURCE_DIR +
      "/scenes/cornell.json --camera red --vary preset=paper,best --basis sh2 --width 16 --height 9 --grid 8 "
      "--spp 1 --frames 1 --format json --cache " +
      folder.path().string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json cells = nlohmann::json::parse(outcome.out).at("cells");
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_NE(cells[0]["nrmse"], cells[1]["nrmse"]);
}

TEST(Presets, HelpStatesThem) {
  const test::Outcome outcome = test::run(std::string(CLPV_PROGRAM) + " render --help");
  EXPECT_THAT(outcome.out, HasSubstr("paper: the published scheme --basis srbf8v2"));
}

}  // namespace
}  // namespace clpv
