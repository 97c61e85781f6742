// SPDX-License-Identifier: MIT
// Quality runs: the matrix of variants, cached cells of a stopped run, reports, and the command.
#include "quality/quality.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "image/image_io.hpp"
#include "support/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/quality_room.hpp"
#include "tests/support/run_here.hpp"
#include "times/time_record.hpp"

namespace clpv::quality_test {
namespace fs = std::filesystem;
using test::QualityCommand;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

std::string rejection(const std::string& vary) {
  return test::error_of(ExitCode::usage, [&] { parse_varied(vary); });
}

TEST(QualityMatrix, EveryCombinationOnceLastOptionFastest) {
  const std::vector<Variant> all =
      combinations({parse_varied("basis=sh2,srbf8v2"), parse_varied("iterations=4,8,16")});
  ASSERT_EQ(all.size(), 6u);
  EXPECT_THAT(all[0], ElementsAre(Pair("basis", "sh2"), Pair("iterations", "4")));
  EXPECT_THAT(all[1], ElementsAre(Pair("basis", "sh2"), Pair("iterations", "8")));
  EXPECT_THAT(all[5], ElementsAre(Pair("basis", "srbf8v2"), Pair("iterations", "16")));
  EXPECT_EQ(combinations({}).size(), 1u);
  EXPECT_EQ(describe(all[1]), "basis=sh2 iterations=8");
}

TEST(QualityMatrix, RejectsOptionsThatCannotVary) {
  EXPECT_THAT(rejection("basis"), HasSubstr("OPTION=a,b,c"));
  EXPECT_THAT(rejection("fog=1,2"), HasSubstr("fog"));
  EXPECT_THAT(rejection("basis=sh2,sh99"), HasSubstr("sh99"));
  EXPECT_THAT(rejection("iterations=4,,8"), HasSubstr("iterations"));
  EXPECT_THAT(rejection("iterations=4,4"), HasSubstr("duplicate value"));
  EXPECT_THROW(combinations({parse_varied("basis=sh2"), parse_varied("basis=sh3")}), Error);
}

TEST(QualityMatrix, ACellsKeyDependsOnNameAndPixelsOfItsTruth) {
  GroundTruth truth{make_image(2, 1, {"indirect.R"}), "room-front-0.exr"};
  std::set<std::string> keys;
  const auto add = [&] { keys.insert(quality_key(truth, {}, {}, Show::indirect, 1, 1)); };
  add();
  truth.image.pixels[1] = 0.5f, add();
  truth.file = "room-back-0.exr", add();
  EXPECT_EQ(keys.size(), 3u);
}

QualityCell cell(const std::string& basis, const std::string& camera, double nrmse, double ms) {
  QualityCell c;
  c.scene = "room";
  c.camera = camera;
  c.variant = {{"basis", basis}};
  c.nrmse = nrmse;
  c.best_gain = 0.9;
  c.nrmse_best_gain = nrmse / 2;
  c.energy_ratio = 1.5;
  c.flip = 0.25;
  c.times = {time_record("frame", {ms}), time_record("propagate", {ms / 2}),
             time_record("rasterize-rsm", {ms / 4}), time_record("rasterize-camera", {ms / 4})};
  return c;
}

QualityCell rejected(const std::string& basis, const std::string& camera) {
  QualityCell c = cell(basis, camera, 0, 0);
  c.nrmse.reset(), c.best_gain.reset(), c.nrmse_best_gain.reset(), c.energy_ratio.reset(),
      c.flip.reset();
  c.times.clear();
  c.rejected = "a \"quoted\" reason, with a comma";
  return c;
}

TEST(QualityReport, SummariesAreMeansBestFirst) {
  const auto sums =
      summarise({cell("sh2", "a", 0.9, 10), cell("sh2", "b", 0.5, 30), rejected("sh4", "a"),
                 cell("sh4", "b", 0.1, 10), cell("sh3", "a", 0.4, 20), cell("sh3", "b", 0.6, 40)});
  ASSERT_EQ(sums.size(), 3u);
  EXPECT_EQ(sums[0].variant[0].second, "sh3");
  EXPECT_DOUBLE_EQ(sums[0].nrmse.value(), 0.5);
  EXPECT_DOUBLE_EQ(sums[0].worst_nrmse.value(), 0.6);
  EXPECT_DOUBLE_EQ(sums[0].frame_ms.value(), 30);
  EXPECT_DOUBLE_EQ(sums[0].stage_ms.at("propagate"), 15);
  EXPECT_DOUBLE_EQ(sums[1].nrmse_best_gain.value(), 0.35);
  EXPECT_EQ(sums[2].rejected, 1)
      << "a low error on one view does not make up for one that is missing";
}

/// A cell over a black ground truth, into which the variant leaks light.
QualityCell leaking(const std::string& basis, const std::string& camera) {
  QualityCell c = cell(basis, camera, 0, 10);
  c.nrmse.reset(), c.nrmse_best_gain.reset(), c.energy_ratio.reset();
  return c;
}

// Undefined errors once counted as 0: the variant that leaked most came first.
TEST(QualityReport, UndefinedIsNeverBestAndInNoMean) {
  const std::vector<QualityCell> cells{leaking("leaks", "dark"),     cell("leaks", "lit", 0.1, 20),
                                       cell("tight", "dark", 0, 10), cell("tight", "lit", 0.4, 20),
                                       leaking("black", "dark"),     leaking("black", "lit"),
                                       rejected("none", "dark"),     rejected("none", "lit")};
  const auto sums = summarise(cells);
  ASSERT_EQ(sums.size(), 4u);
  EXPECT_EQ(sums[0].variant[0].second, "tight");
  EXPECT_EQ(sums[1].variant[0].second, "leaks");
  EXPECT_EQ(sums[1].undefined, 1);
  EXPECT_DOUBLE_EQ(sums[1].nrmse.value(), 0.1) << "of the lit view";
  EXPECT_DOUBLE_EQ(sums[1].energy_ratio.value(), 1.5);
  EXPECT_DOUBLE_EQ(sums[1].flip.value(), 0.25);
  EXPECT_DOUBLE_EQ(sums[1].frame_ms.value(), 15);
  EXPECT_EQ(sums[2].variant[0].second, "black");
  EXPECT_EQ(sums[3].variant[0].second, "none");
  for (const char* key : {"nrmse", "worst_nrmse", "nrmse_best_gain", "energy_ratio"})
    EXPECT_TRUE(to_json(sums[2]).at(key).is_null()) << key;
  EXPECT_TRUE(to_json(sums[3]).at("frame_ms").is_null());
  const std::string table = quality_table(cells);
  EXPECT_THAT(table, HasSubstr("undefined, as over a black ground truth: 3 of 8 errors"));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("nan")));
}

TEST_F(QualityCommand, ACacheThatCannotBeWrittenIsReported) {
  std::ofstream(file("cache")) << "a file, so that no folder of this name can be made";
  const test::Outcome outcome = quality("--basis sh2 --camera left --format json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("results are not cached"));
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["variants"].size(), 1u);
}

TEST_F(QualityCommand, MeasuresAMatrixAndResumes) {
  method = " --grid 16 --transport sampled --blockers none ";
  const std::string matrix = "--vary basis=sh2,srbf4 --format json --output " + file("a.json");
  const test::Outcome first = quality(matrix);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const nlohmann::json json = nlohmann::json::parse(first.out);
  EXPECT_EQ(json["schema"], 2);
  ASSERT_EQ(json["cells"].size(), 4u);
  ASSERT_EQ(json["variants"].size(), 2u);
  ASSERT_EQ(json["ground_truths"].size(), 2u);
  for (const nlohmann::json& one : json["cells"]) {
    EXPECT_EQ(one["rejected"], "") << one.dump();
    EXPECT_GT(one["nrmse"], 0.01);
    EXPECT_LT(one["nrmse"], 5);
    EXPECT_LE(one["nrmse_best_gain"].get<double>(), one["nrmse"]);
    EXPECT_GT(one["energy_ratio"], 0.05);
    const std::vector<TimeRecord> times = one["times"];
    EXPECT_GT(ms_of(times, "propagate"), 0);
    EXPECT_GT(ms_of(times, "frame"), ms_of(times, "propagate"));
  }
  EXPECT_NE(json["cells"][0]["nrmse"], json["cells"][2]["nrmse"]) << "bases differ";
  EXPECT_EQ(kept(), 4u);

  // As if stopped before the last cell: three are read back with their times, the fourth is
  // measured.
  fs::remove(fs::directory_iterator(file("cache/cells"))->path());
  const test::Outcome second = quality(matrix);
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const nlohmann::json again = nlohmann::json::parse(second.out);
  int same_times = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(again["cells"][i]["nrmse"], json["cells"][i]["nrmse"]);
    const bool same = again["cells"][i]["times"] == json["cells"][i]["times"];
    EXPECT_EQ(again["cells"][i]["cached"], same);
    same_times += same;
  }
  EXPECT_EQ(same_times, 3);
  EXPECT_EQ(kept(), 4u);
  EXPECT_EQ(test::read_file(file("a.json")), second.out);
}

TEST_F(QualityCommand, AnImageHasTheHashOfTheTruthOfItsScene) {
  const std::string render = "render " + file("room.json") +
                             " --view indirect --width 32 --height 18 --rsm-size 16" +
                             test::kSweepOfOne + "--camera left -o " + file("ours.exr");
  const auto hash_of = [](const fs::path& image) {
    return read_image(image).metadata["view_hash"];
  };
  ASSERT_EQ(quality("--basis sh2 --camera left").exit_code, 0);
  const std::string truth = hash_of(fs::directory_iterator(file("cache/references"))->path());
  EXPECT_EQ(truth.size(), 16u);
  ASSERT_EQ(test::run_here(render).exit_code, 0);
  EXPECT_EQ(hash_of(file("ours.exr")), truth);
  ASSERT_EQ(test::run_here(render + " --sun 0,-1,-0.4").exit_code, 0);
  EXPECT_NE(hash_of(file("ours.exr")), truth) << "another sun";
}

}  // namespace clpv::quality_test
