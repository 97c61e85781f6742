// SPDX-License-Identifier: MIT
// Benchmarks: statistics, reports, comparison of runs, and what
// `clpv bench` does as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/baseline/avx2.hpp"
#include "bench/ceilings.hpp"
#include "bench/compare_runs.hpp"
#include "bench/published.hpp"
#include "bench/report.hpp"
#include "bench/statistics.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kProgram = CLPV_PROGRAM;

TEST(BenchStatistics, MedianSpreadAndQuantilesOfAKnownSeries) {
  const Statistics s = statistics_of({5, 1, 4, 2, 103});
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.median, 4);
  EXPECT_EQ(s.max, 103);
  EXPECT_EQ(s.mad, 2);                     // of 3 2 0 1 99
  EXPECT_NEAR(s.p95, 5 + 0.8 * 98, 1e-9);  // between the 4th and the 5th, at 3.8
  EXPECT_EQ(statistics_of({}).median, 0);
}

TEST(BenchStatistics, ExponentOfAPower) {
  EXPECT_NEAR(growth_exponent({16, 32, 64}, {3 * 16.0 * 16 * 16, 3 * 32.0 * 32 * 32, 3 * 64.0 * 64 * 64}), 3,
              1e-9);
}

/// A row of the suite whose work is held against another's.
TEST(BenchProgram, BaselineTellsTheSweepOverTheSameByHand) {
  if (!baseline_supported()) GTEST_SKIP() << "no AVX2";
  const auto out = test::run(kProgram + " bench baseline --repetitions 1 --filter 'bins24.*occlusion'");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("over C++"));
  EXPECT_THAT(out.out, ::testing::ContainsRegex(
                           "sweep/bins24/soa/float/occlusion .*[0-9]+[.][0-9]+ +[0-9.]+ +[0-9.e-]+\n"));
  EXPECT_THAT(out.out, HasSubstr("native/bins24/soa/float/sweep/occlusion"));
}

TEST(BenchProgram, TheSweepIsRightInFloatsAndHalves) {
  const auto out = test::run(
      kProgram + " bench regression --basis bins24 --repetitions 1 --filter '^sweep' --format json");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const nlohmann::json document = nlohmann::json::parse(out.out);
  std::vector<std::string> names;
  for (const auto& row : document["benchmarks"]) {
    names.push_back(row["name"]);
    EXPECT_EQ(row["status"], "ok") << row["name"];
    if (row["stage"] != "sweep") continue;  // its build
    EXPECT_EQ(row["transport"], "sweep");
    EXPECT_LE(row["max_rel_error"], row["tolerance"]) << row["name"];
  }
  EXPECT_THAT(names, ::testing::IsSupersetOf({"sweep/bins24/soa/float", "sweep/bins24/soa/float/occlusion",
                                              "sweep/bins24/soa/half"}));
}

TEST(BenchCeilings, TheLongestOfTheLeastTimesBinds) {
  Ceilings ceilings{100, {{1e6, 50}, {1e9, 10}}, 0.001};
  Row row;
  row.times.median = 4;
  row.cost = {.flops = 1e8, .bytes = 5e6, .working_set = 5e5};  // 1 ms, 0.1 ms in cache
  bind(ceilings, row);
  EXPECT_EQ(row.ceiling, "fma");
  EXPECT_NEAR(row.ceiling_share, 0.25, 1e-9);
  row.cost.working_set = 2e6, row.cost.bytes = 2e7;  // out of the cache: 2 ms
  bind(ceilings, row);
  EXPECT_EQ(row.ceiling, "bandwidth");
  EXPECT_NEAR(row.ceiling_share, 0.5, 1e-9);
  EXPECT_EQ(ceilings.gbps(1e12), 10);
}

TEST(BenchReport, CsvQuotesWhatItMustAndKeepsColumns) {
  Row plain, odd;
  plain.name = "a", odd.name = "b";
  odd.status = Status::unsupported;
  odd.reason = "no \"images\", none";
  const std::string csv = report_csv({plain, odd});
  EXPECT_THAT(csv, HasSubstr("\"no \"\"images\"\", none\""));
  std::istringstream lines(csv);
  std::string head, first;
  std::getline(lines, head);
  std::getline(lines, first);
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(first.begin(), first.end(), ','));
}

nlohmann::json report(const std::vector<std::tuple<std::string, double, double>>& rows) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [name, median, mad] : rows)
    list.push_back({{"name", name}, {"status", "ok"}, {"median", median}, {"mad", mad}});
  return {{"context", {{"schema", 1}}}, {"benchmarks", list}};
}

TEST(BenchCompare, TellsAChangeFromTheSpread) {
  const auto before =
      report({{"same", 10, 0.1}, {"slow", 10, 0.1}, {"noisy", 10, 2}, {"fast", 10, 0}, {"gone", 1, 0}});
  const auto after =
      report({{"same", 10.05, 0.1}, {"slow", 13, 0.1}, {"noisy", 13, 2}, {"fast", 5, 0}, {"new", 1, 0}});
  const Comparison found = compare_runs(before, after, "old.json");
  ASSERT_EQ(found.changes.size(), 4u);
  EXPECT_FALSE(found.changes[0].clear);
  EXPECT_TRUE(found.changes[1].clear);
  EXPECT_NEAR(found.changes[1].ratio(), 1.3, 1e-12);
  EXPECT_FALSE(found.changes[2].clear);
  EXPECT_TRUE(found.changes[3].clear);
  EXPECT_EQ(found.only_before, std::vector<std::string>{"gone"});
  EXPECT_EQ(found.only_after, std::vector<std::string>{"new"});
  const std::string table = comparison_table(found);
  EXPECT_THAT(table, HasSubstr("13.0000 +- 0.1000    1.300 SLOWER"));
  EXPECT_THAT(table, HasSubstr("0.500 faster"));
}

TEST(BenchCompare, RefusesWhatIsNoReport) {
  EXPECT_THROW(compare_runs(nlohmann::json::array(), report({}), "old.json"), Error);
  EXPECT_THROW(
      compare_runs({{"context", {{"schema", 2}}}, {"benchmarks", nlohmann::json::array()}}, report({}), "o"),
      Error);
}

/// The paper's Table 1 as its page has it: small/medium/big of injection, the same of propagation, light buffer.
struct PublishedLine {
  const char* basis;
  bool shadows;
  const char* cells;
};
constexpr PublishedLine kPublishedLines[] = {{"sh2", true, "2.028 2.292 2.339 2.241 2.565 2.275 1.086"},
                                             {"srbf4", true, "2.090 2.314 2.351 4.139 4.974 4.200 1.214"},
                                             {"srbf8v2", true, "3.544 4.488 4.299 9.663 10.602 9.386 1.723"},
                                             {"sh2", false, "2.025 2.294 2.340 1.957 2.125 1.986 1.135"},
                                             {"srbf4", false, "2.086 2.281 2.344 3.183 3.797 3.177 1.206"},
                                             {"srbf8v2", false, "3.511 4.460 4.276 7.427 7.794 7.019 1.721"}};

TEST(BenchPublished, HoldsAllCellsOfTheTable) {
  int cells = 0;
  for (const PublishedLine& line : kPublishedLines) {
    std::istringstream text(line.cells);
    const auto expect = [&](Pass pass, std::optional<int> cascade) {
      double printed = 0;
      text >> printed;
      const auto held = published_ms(pass, line.basis, line.shadows, cascade);
      ASSERT_TRUE(held.has_value());
      EXPECT_EQ(*held, printed) << line.basis << ' ' << line.shadows << ' ' << name_of(pass);
      ++cells;
    };
    for (int cascade = 0; cascade < 3; ++cascade) expect(Pass::inject_light, cascade);
    for (int cascade = 0; cascade < 3; ++cascade) expect(Pass::propagate, cascade);
    expect(Pass::gather, std::nullopt);
  }
  EXPECT_EQ(cells, 42);
  EXPECT_FALSE(published_ms(Pass::inject_geometry, "sh2", true, 0));
  EXPECT_FALSE(published_ms(Pass::propagate, "sh2", true, 3));
  EXPECT_FALSE(published_ms(Pass::propagate, "sh3", true, 0));
}

TEST(BenchPublished, SumsAndRatiosAreThoseOfTheTable) {
  const auto ratio = [](bool shadows) {
    double sh2 = 0, srbf = 0;
    for (const PublishedTimes& times : kPublishedTimes) {
      if (times.shadows != shadows) continue;
      if (times.basis == "sh2") sh2 = times.sum();
      if (times.basis == "srbf8v2") srbf = times.sum();
    }
    return srbf / sh2;
  };
  EXPECT_NEAR(ratio(true), 2.95, .005);
  EXPECT_NEAR(ratio(false), 2.61, .005);
  const double cascades[2][3] = {{3.80, 3.67, 3.53}, {4.31, 4.13, 4.13}};
  for (const bool shadows : {false, true}) {
    for (int cascade = 0; cascade < 3; ++cascade) {
      EXPECT_NEAR(*published_ms(Pass::propagate, "srbf8v2", shadows, cascade) /
                      *published_ms(Pass::propagate, "sh2", shadows, cascade),
                  cascades[shadows][cascade], .005);
    }
  }
}

/// Every key of docs/benchmarks.md, in its range.
std::vector<Rule> row_schema() {
  std::vector<Rule> rules = {rule::object(""),
                             rule::object("/context").must(),
                             rule::list("/benchmarks", 1, 1000).must(),
                             rule::integer("/context/schema", 1, 1).must(),
                             rule::number("/context/ceilings/gflops", 1e-3, 1e9).must(),
                             rule::object("/benchmarks/*")};
  for (const char* key : {"date", "host_name", "device", "driver", "platform", "build_options", "kernel_hash",
                          "git_describe", "host_cpu", "clpv_version", "executable", "library_build_type"})
    rules.push_back(rule::text(std::string("/context/") + key).must());
  const std::string row = "/benchmarks/*/";
  for (const char* key :
       {"name", "run_name", "suite", "stage", "basis", "layout", "storage", "state", "lobe", "transport"})
    rules.push_back(rule::text(row + key).must());
  rules.push_back(rule::text(row + "run_type", {"iteration"}).must());
  rules.push_back(rule::text(row + "status", {"ok", "unsupported", "wrong", "timed out"}).must());
  rules.push_back(rule::text(row + "time_unit", {"ms"}).must());
  rules.push_back(rule::text(row + "ceiling", {"fma", "bandwidth", "launch"}).must());
  rules.push_back(rule::flag(row + "occlusion").must());
  rules.push_back(rule::flag(row + "filtered").must());
  rules.push_back(rule::list(row + "samples_ms", 3, 3).must());
  for (const char* key : {"n", "grid", "iterations", "repetitions", "threads", "family_index"})
    rules.push_back(rule::integer(row + key, 0, 1e6).must());
  for (const char* key : {"min",
                          "median",
                          "p95",
                          "max",
                          "mad",
                          "real_time",
                          "cpu_time",
                          "wall_ms",
                          "first_launch_ms",
                          "build_ms",
                          "device_bytes",
                          "host_bytes",
                          "flops",
                          "bytes",
                          "reads_per_cell",
                          "writes_per_cell",
                          "gflops",
                          "gbps",
                          "max_rel_error",
                          "tolerance"})
    rules.push_back(rule::number(row + key, 0, 1e15).must());
  rules.push_back(rule::number(row + "ceiling_share", 0, 2).must());
  return rules;
}

const std::string kOneRow = " bench bases --basis sh2 --filter 'propagate/sh2/soa/float$' --repetitions 3";

TEST(BenchProgram, JsonHasEveryKeyAndComparesWithItself) {
  const test::TemporaryFolder folder;
  const std::string old = (folder.path() / "old.json").string();
  const auto out = test::run(kProgram + kOneRow + " --format json --out " + old);
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_EQ(out.out, "");
  nlohmann::json document = nlohmann::json::parse(test::read_file(old));
  EXPECT_NO_THROW(check_rules(document, row_schema(), old));
  const nlohmann::json& row = document["benchmarks"][0];
  EXPECT_EQ(row["name"], "propagate/sh2/soa/float");
  EXPECT_EQ(row["status"], "ok");
  EXPECT_LE(row["max_rel_error"], row["tolerance"]);
  EXPECT_GT(row["flops"], 32.0 * 32 * 32 * 3 * 8 * 36);  // at least the multiply-adds of docs/method.md

  document["benchmarks"][0]["median"] = 1e-3 * row["median"].get<double>();
  std::ofstream(old) << document.dump();
  const auto compared = test::run(kProgram + kOneRow + " --compare " + old);
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  // A thousand times as long; on a busy machine that may be within the spread.
  EXPECT_THAT(compared.out, ::testing::ContainsRegex("[0-9]{2,}[.][0-9]{3} (SLOWER|within the spread)"));
}

TEST(BenchProgram, RowsOfScalingSayWhatTheyArePointsOf) {
  const auto out =
      test::run(kProgram + " bench scaling --filter 'iterations:4$' --repetitions 1 --format json");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const nlohmann::json row = nlohmann::json::parse(out.out)["benchmarks"][0];
  EXPECT_EQ(row["axis"], "iterations");
  EXPECT_EQ(row["value"], 4);
}

TEST(BenchProgram, GatheringIsTimedAndRight) {
  const auto out = test::run("cd " CLPV_SOURCE_DIR " && " + kProgram +
                             " bench table1 --repetitions 1 --filter 'gather/sh2/soa' --format json");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const auto document = nlohmann::json::parse(out.out);
  ASSERT_FALSE(document["benchmarks"].empty());
  for (const auto& row : document["benchmarks"]) EXPECT_EQ(row["status"], "ok") << row["name"];
}

TEST(BenchProgram, Table1StandsBesideThePublishedTimes) {
  const std::string command = "cd " CLPV_SOURCE_DIR " && " + kProgram +
                              " bench table1 --repetitions 1 --filter 'inject-.*/sh2/image.*/cascade:0'";
  const auto table = test::run(command);
  ASSERT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("scene: atrium, camera nave"));
  EXPECT_THAT(table.out, ::testing::ContainsRegex("injection, small +2\\.028 +[0-9.]+"));
  EXPECT_THAT(table.out, ::testing::ContainsRegex("geometry volume, small +- +[0-9.]+"));
  const auto json = test::run(command + " --format json");
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const auto document = nlohmann::json::parse(json.out);
  EXPECT_EQ(document["context"]["scene"], "atrium, camera nave");
  const auto& rows = document["benchmarks"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["name"], "inject-light/sh2/image/half/rotate-kernel/occlusion/cascade:0");
  EXPECT_EQ(rows[0]["published_ms"], 2.028);
  EXPECT_TRUE(rows[1]["published_ms"].is_null());
  EXPECT_EQ(rows[2]["published_ms"], 2.025);
}

TEST(BenchProgram, AnAlteredLiteralIsCaught) {
  const test::TemporaryFolder folder;
  std::string text = test::read_file(std::string(CLPV_SOURCE_DIR) + "/kernels/propagate.cl");
  const std::string sum = "r.c##i = a.c##i + b.c##i;";
  const auto at = text.find(sum);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, sum.size(), "r.c##i = a.c##i + 1.0001f * b.c##i;");
  std::ofstream(folder.path() / "propagate.cl") << text;
  const auto out = test::run("CLPV_KERNEL_DIR=" + folder.path().string() + " CLPV_PROGRAM_CACHE=off " +
                             kProgram + kOneRow);
  EXPECT_EQ(out.exit_code, static_cast<int>(ExitCode::validation)) << out.out << out.err;
  EXPECT_THAT(out.out, HasSubstr("WRONG"));
  EXPECT_THAT(out.err, HasSubstr("propagate/sh2/soa/float"));
}

TEST(BenchProgram, RefusesBadUsage) {
  const auto code = [](const std::string& arguments) {
    return test::run(kProgram + " bench " + arguments).exit_code;
  };
  EXPECT_EQ(code("nothing"), 2);
  EXPECT_EQ(code("bases --filter '['"), 2);
  EXPECT_EQ(code("ceilings --filter nothing-of-that-name"), 2);
  EXPECT_EQ(code("bases --repetitions 0"), 2);
  EXPECT_EQ(code("bases --basis sh17"), 2);
  EXPECT_EQ(code("bases --format xml"), 2);
  EXPECT_EQ(code("bases --model x.gltf"), 2);
  EXPECT_EQ(code("ceilings --format json --compare old.json"), 2);
  EXPECT_EQ(code("ceilings --compare /nowhere/old.json"), 3);
  EXPECT_EQ(code("ceilings --out /nowhere/new.json"), 1);
}

TEST(BenchProgram, PlotDrawsTheRoofline) {
  const test::TemporaryFolder folder;
  const auto out = test::run(kProgram + kOneRow + " --plot " + folder.path().string());
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(test::read_file(folder.path() / "roofline.svg"), HasSubstr("<svg"));
  EXPECT_THAT(test::read_file(folder.path() / "roofline.png"), HasSubstr("PNG"));
}

/// A device whose every kernel hangs, after so many that do not.
TEST(BenchProgram, ARowThatHangsIsTimedOutAndTheRestIsTold) {
  const test::TemporaryFolder folder;
  const std::string log = (folder / "rows.jsonl").string();
  const auto out =
      test::run("CLPV_SHIM=clFinish:40:hang LD_PRELOAD=" CLPV_OPENCL_SHIM " timeout 120 " + kProgram +
                " bench ceilings --repetitions 20 --filter launch --row-limit 20 --format json --log " + log);
  EXPECT_EQ(out.exit_code, 1) << out.err;
  EXPECT_THAT(out.err, HasSubstr("the run ends with it"));
  const nlohmann::json rows = nlohmann::json::parse(out.out)["benchmarks"];
  EXPECT_EQ(rows.back()["status"], "timed out");
  EXPECT_THAT(rows.back()["name"].get<std::string>(), HasSubstr("launch"));
  EXPECT_THAT(test::read_file(log), HasSubstr("\"status\":\"timed out\""));
}

TEST(BenchProgram, RegressionTellsBuildsAsRowsAndSpeaksToActions) {
  const auto out = test::run(kProgram +
                             " bench regression --basis sh2 --repetitions 2"
                             " --filter 'propagate/sh2/soa/float$' --format github-action");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const nlohmann::json rows = nlohmann::json::parse(out.out);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["name"], "propagate/sh2/soa/float");
  EXPECT_EQ(rows[1]["name"], "build/propagate/sh2/soa/float");
  for (const auto& row : rows) {
    EXPECT_EQ(row["unit"], "ms");
    EXPECT_GT(row["value"], 0);
  }
  EXPECT_GT(rows[1]["value"], rows[0]["value"]) << "a build takes longer than a launch";
}

}  // namespace
}  // namespace clpv::bench
