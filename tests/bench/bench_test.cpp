// SPDX-License-Identifier: MIT
// Benchmarks: statistics, reports, comparison of reports, suites, and the command `clpv bench`.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "bench/row.hpp"
#include "bench/runner.hpp"
#include "bench/suites.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_here.hpp"
#include "times/time_record.hpp"

namespace clpv::bench {

// Small runs of suites of `clpv bench`.

/// Small enough that compiling dominates the time.
inline SuiteOptions small() {
  SuiteOptions options;
  options.scene = std::make_shared<SceneData>(load_scene(CLPV_SOURCE_DIR "/scenes/atrium.json"));
  options.settings.grid = 16, options.settings.rsm_size = 64, options.settings.shadow_size = 128;
  options.settings.width = 96, options.settings.height = 54;
  return options;
}

/// Rows of a suite in whose names `filter` is found, timed once on the tests' device.
inline std::vector<Row> rows_of(const Suite& suite, const std::string& filter,
                                const SuiteOptions& options = small()) {
  std::vector<Row> rows;
  for (Group& cases : suite.groups(test::test_session(), options)) {
    std::erase_if(
        cases, [&](const Case& c) { return !std::regex_search(c.row.name, std::regex(filter)); });
    std::ranges::move(run_cases(test::test_session(), cases, {.repetitions = 1}),
                      std::back_inserter(rows));
  }
  return rows;
}

inline void expect_right(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    EXPECT_EQ(row.status, Status::ok) << row.name << ": " << row.reason;
    EXPECT_LE(row.max_rel_error.value_or(0), row.tolerance) << row.name;
  }
}

}  // namespace clpv::bench

namespace clpv::bench::bench_test {

namespace {

using ::testing::HasSubstr;

TEST(BenchStatistics, MedianSpreadAndQuantilesOfAKnownSeries) {
  const Statistics s = statistics_of({5, 1, 4, 2, 103});
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.median, 4);
  EXPECT_EQ(s.max, 103);
  EXPECT_EQ(s.mad, 2);                     // median of 3 2 0 1 99
  EXPECT_NEAR(s.p95, 5 + 0.8 * 98, 1e-9);  // between the 4th and the 5th, at 3.8
  EXPECT_EQ(statistics_of({}).median, 0);
}

nlohmann::json report(const std::vector<std::tuple<std::string, double, double>>& rows) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [name, median, mad] : rows) {
    nlohmann::json row = TimeRecord{"gather", {}, {}, 5, median, median, mad, median};
    row.update({{"name", name}, {"status", "ok"}});
    list.push_back(row);
  }
  return {{"context", {{"schema", 2}}}, {"benchmarks", list}};
}

const std::string kOneRow = "layouts --scene " CLPV_SOURCE_DIR
                            "/scenes/atrium.json --basis sh2 --filter 'propagate/sh2/soa/float$' "
                            "--repetitions 3";

/// Runs `clpv compare NEW OLD` on these reports.
test::Outcome compare_files(const nlohmann::json& before, const nlohmann::json& after,
                            const std::string& options = " --fail-above 1.2") {
  const test::TemporaryFolder folder;
  const std::string old = folder.write("old.json", before.dump()).string(),
                    now = folder.write("new.json", after.dump()).string();
  return test::run_here("compare " + now + " " + old + options);
}

/// A report of quality: a lit view, and a dark one without error relative to its ground truth.
nlohmann::json two_cells() {
  const auto cell = [](const char* camera, const nlohmann::json& nrmse) {
    return nlohmann::json{{"scene", "s"},   {"camera", camera},
                          {"rejected", ""}, {"options", nlohmann::json::object()},
                          {"nrmse", nrmse}, {"times", {time_record("frame", {10})}}};
  };
  return {{"cells", {cell("lit", 0.2), cell("dark", nullptr)}}};
}

// `--fail-above` once passed each of these.
TEST(BenchCompare, AGateWithoutAComparisonFails) {
  const nlohmann::json bench = report({{"a", 10, 0.1}, {"b", 10, 0.1}}), quality = two_cells();
  const auto changed = [](nlohmann::json report, const char* place, const nlohmann::json& value) {
    report[nlohmann::json::json_pointer(place)] = value;
    return report;
  };
  const nlohmann::json none = nlohmann::json::array();
  const auto stats = [](double ms) {
    return nlohmann::json{
        {"times", {time_record("frame", {2 * ms}), time_record({Pass::gather, 1}, {ms})}}};
  };
  const nlohmann::json once = changed(report({{"a", 10, 0}}), "/benchmarks/0/n", 1);
  struct Gate {
    nlohmann::json before, after;
    int code;
    const char* word;
  };
  for (const Gate& gate : std::vector<Gate>{
           {bench, report({}), 5, "2 rows have lost their value: a (not in this run)"},
           {report({}), report({}), 5, "no row has a value in both"},
           {report({}), bench, 5, "no row has a value in both"},
           {bench, report({{"a", 10, 0.1}}), 5, "b (not in this run)"},
           {bench, report({{"a", 10, 0.1}, {"B", 10, 0.1}}), 5, "b (not in this run)"},
           {bench, changed(bench, "/benchmarks/1/status", "unsupported"), 5, "b (unsupported)"},
           {bench, changed(bench, "/benchmarks/1/status", "wrong"), 5, "b (wrong)"},
           {bench, changed(bench, "/benchmarks/1/median", nullptr), 3, "/benchmarks/1/median"},
           {bench, changed(bench, "/benchmarks/1/median", "10"), 3, "/benchmarks/1/median"},
           {report({{"a", 0, 0}}), report({{"a", 1, 0}}), 5, "a (inf)"},
           {report({{"a", 10, 0}, {"a", 10, 0}}), report({{"a", 10, 0}}), 5, "a (2)"},
           {report({{"a", 10, 0}, {"a", 10, 0}}), report({{"a", 20, 0}, {"a", 10, 0}}), 5,
            "a (2.000)"},
           {report({{"a", 10, 0}, {"a", 10, 0}}), report({{"a", 10, 0}, {"a", 10, 0}}), 0, ""},
           {quality, changed(quality, "/cells", none), 5, "s:lit nrmse (not in this run)"},
           {quality, changed(quality, "/cells/0/rejected", "why"), 5, "s:lit nrmse (rejected)"},
           {quality, changed(quality, "/cells/0/nrmse", nullptr), 5, "s:lit nrmse (undefined)"},
           {quality, changed(quality, "/cells/0/nrmse", "0.2"), 3, "/cells/0/nrmse"},
           {quality, changed(quality, "/cells/0/nrmse", -1), 3, "/cells/0/nrmse"},
           {quality, changed(quality, "/cells/0/camera", "other"), 5, "s:lit nrmse"},
           {quality, changed(quality, "/cells/0/nrmse", 0.3), 5, "s:lit nrmse (1.500)"},
           {stats(10), stats(13), 5, "gather/cascade:1 (1.300)"},
           {stats(10), quality, 3, "two reports of one command"},
           {stats(10), stats(11), 0, ""},
           {bench, bench, 0, ""},
           {report({{"noisy", 10, 5}}), report({{"noisy", 15, 5}}), 0, ""},
           {report({{"slow", 10, 0.1}}), report({{"slow", 15, 0.1}}), 5, "slow (1.500)"},
           {report({{"a", 0, 0}}), report({{"a", 0, 0}}), 0, ""},
           {once, report({{"a", 11, 0}}), 0, ""},
           {once, report({{"a", 13, 0}}), 5, "a (1.300)"},
           {changed(bench, "/benchmarks/1/status", "unsupported"),
            changed(bench, "/benchmarks/1/status", "unsupported"), 0, ""},
           {quality, quality, 0, ""},
       }) {
    const test::Outcome outcome = compare_files(gate.before, gate.after);
    EXPECT_EQ(outcome.exit_code, gate.code) << gate.word << outcome.out << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(gate.word));
  }
  EXPECT_THAT(compare_files(quality, quality).out,
              HasSubstr("s:dark nrmse: - (undefined in both)"));
  EXPECT_THAT(compare_files(once, report({{"a", 12, 0}}), "").out, HasSubstr("spread unknown"));
}

// `clpv compare` without a limit once printed an empty table and passed.
TEST(BenchCompare, ReportsWithoutACommonRowFail) {
  const nlohmann::json one = report({{"a", 10, 0.1}}), other = report({{"b", 10, 0.1}});
  const test::Outcome outcome = compare_files(one, other, "");
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.out, HasSubstr("b: only in this run\na: LOST: not in this run"));
  EXPECT_THAT(outcome.err, HasSubstr("no row has a value in both reports"));
  EXPECT_EQ(compare_files(report({{"a", 10, 0.1}, {"b", 10, 0.1}}), other, "").exit_code, 0)
      << "a lost row is reported, and fails only with a limit";
}

/// The keys of bench/README.md: of the context, of a row.
const std::vector<std::string> kContext = test::words_of(
    "date host_name device driver platform build_options kernel_hash git_describe host_cpu "
    "clpv_version executable library_build_type");
const std::vector<std::string> kRow = test::words_of(
    "name run_name suite stage basis layout storage lobe transport run_type status time_unit "
    "occlusion filtered samples_ms coefficients n grid iterations repetitions threads "
    "family_index min "
    "median p95 max mad real_time cpu_time wall_ms first_launch_ms build_ms device_bytes "
    "host_bytes launches fills waits arguments written max_rel_error tolerance");

TEST(BenchSuites, ActionsGetMedians) {
  SuiteOptions options = small();
  options.bases = {"sh2"};
  const std::vector<Row> rows = rows_of(layouts_suite(), "^sweep.*half$", options);
  expect_right(rows);
  EXPECT_EQ(to_json(rows[0], 0)["transport"], "sweep");
  const nlohmann::json actions = nlohmann::json::parse(report_github_action(rows));
  ASSERT_EQ(actions.size(), rows.size());
  EXPECT_EQ(actions[0]["name"], rows[0].name);
  EXPECT_EQ(actions[0]["unit"], "ms");
  EXPECT_GT(actions[0]["value"], 0);
}

TEST(BenchProgram, JsonHasEveryKeyComparesAndIsDrawn) {
  const test::TemporaryFolder folder;
  const std::string now = (folder / "new.json").string();
  const auto out = test::run_here("bench " + kOneRow + " --output " + now);
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_EQ(test::run_here("compare " + now + " " + now + " --fail-above 1.1").exit_code, 0);
  const nlohmann::json document = nlohmann::json::parse(test::read_file(now));
  const nlohmann::json& row = document["benchmarks"][0];
  EXPECT_EQ(document["context"]["schema"], 2);
  for (const std::string& key : kContext) EXPECT_TRUE(document["context"].contains(key)) << key;
  for (const std::string& key : kRow) EXPECT_TRUE(row.contains(key) && !row[key].is_null()) << key;
  EXPECT_EQ(row["samples_ms"].size(), 3u);
  EXPECT_EQ(row["name"], "propagate/sh2/soa/float");
  EXPECT_EQ(row["status"], "ok");
  EXPECT_LE(row["max_rel_error"].get<double>(), row["tolerance"]);
  const std::string page = (folder / "page").string();
  ASSERT_EQ(test::run_here("report " + page + " --bench " + now).exit_code, 0);
  EXPECT_THAT(test::read_file(page + "/index.html"), HasSubstr("<svg"));
}

TEST(BenchProgram, AnAlteredLiteralIsCaught) {
  const test::TemporaryFolder folder;
  std::string text = test::read_file(std::string(CLPV_SOURCE_DIR) + "/kernels/steps/face_flux.h");
  const std::string half = "return 0.5f *";
  const auto at = text.find(half);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, half.size(), "return 0.50005f *");
  folder.write("steps/face_flux.h", text);
  const auto out = test::run("CLPV_KERNEL_DIR=" + folder.path().string() +
                             " CLPV_PROGRAM_CACHE=off " CLPV_PROGRAM " " + "bench " + kOneRow);
  EXPECT_EQ(out.exit_code, static_cast<int>(ExitCode::validation)) << out.out << out.err;
  EXPECT_THAT(out.out, HasSubstr("WRONG"));
  EXPECT_THAT(out.err, HasSubstr("propagate/sh2/soa/float"));
}

}  // namespace

}  // namespace clpv::bench::bench_test
