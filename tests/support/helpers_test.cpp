// SPDX-License-Identifier: MIT
// Helper processes: each job is taken once, and with their help a first run gives the same image
// and the same checks.
#include "support/helpers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "support/error.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"
#include "verify/check.hpp"
#include "verify/schedule.hpp"

namespace clpv::helpers_test {
namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Claims, EachJobIsTakenOnce) {
  const test::TemporaryFolder folder;
  const Claims claims(folder.path());
  std::atomic<int> taken{0};
  std::vector<std::thread> takers;
  for (int i = 0; i < 4; ++i) {
    takers.emplace_back([&] {
      for (int job = 0; job < 50; ++job) taken += claims.take("job" + std::to_string(job)) ? 1 : 0;
    });
  }
  for (std::thread& taker : takers) taker.join();
  EXPECT_EQ(taken, 50);
}

const std::string kFrame = " -v render " + test::kTiny + test::kSmallSteps + "-o ";

/// The variables of empty caches in that folder.
std::string caches(const fs::path& folder) {
  fs::create_directories(folder / "pocl");
  return "XDG_CACHE_HOME=" + folder.string() + " POCL_CACHE_DIR=" + (folder / "pocl").string() +
         " ";
}

TEST(FirstRun, HelpersCompileForTheSameImage) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "helpers need a second core";
  const test::TemporaryFolder folder;
  const std::string first = (folder / "first.exr").string(),
                    second = (folder / "second.exr").string(),
                    alone = (folder / "alone.exr").string();
  const std::string here = caches(folder / "cache");
  const test::Outcome helped = test::run(here + CLPV_PROGRAM + kFrame + first);
  ASSERT_EQ(helped.exit_code, 0) << helped.err;
  EXPECT_THAT(helped.err, ContainsRegex("compiling [0-9]+ kernels for .*, whose cache lacks"));
  EXPECT_THAT(helped.err, ContainsRegex("helpers compiled [1-9][0-9]* kernels"));
  EXPECT_THAT(helped.err, Not(HasSubstr("once for these options")));
  EXPECT_THAT(helped.err, Not(HasSubstr("a helper failed")));
  EXPECT_THAT(helped.err, Not(HasSubstr("warning")));
  const test::Outcome warm = test::run(here + CLPV_PROGRAM + kFrame + second);
  ASSERT_EQ(warm.exit_code, 0) << warm.err;
  EXPECT_THAT(warm.err, Not(HasSubstr("whose cache lacks"))) << "all kernels are marked";
  const test::Outcome one = test::run("taskset -c 0 env " + here + CLPV_PROGRAM + kFrame + alone);
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_TRUE(test::read_file(first) == test::read_file(second) &&
              test::read_file(first) == test::read_file(alone));
}

/// Results of a check without their times.
nlohmann::json results_of(const test::Outcome& outcome) {
  nlohmann::json checks = nlohmann::json::parse(outcome.out).at("checks");
  for (nlohmann::json& check : checks) check.erase("seconds");
  return checks;
}

TEST(Check, HelpersFindWhatOneProcessFinds) {
  const std::string check = CLPV_PROGRAM " check --format json --stage shade,emit,sizes --match ''";
  const test::Outcome helped = test::run(check), alone = test::run("taskset -c 0 " + check);
  ASSERT_EQ(helped.exit_code, 0) << helped.err;
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(results_of(helped), results_of(alone));
}

// Results come in order, while helpers do the last stages first: '1 of 108, 2:13:02 left'.
TEST(Check, ProgressCountsWhatHelpersHaveFinished) {
  set_helper_program(CLPV_PROGRAM);
  verify::CheckChoice choice;
  choice.stages = {Stage::sizes, Stage::emit};
  std::size_t reached = 0, found = 0;
  verify::run_in_helpers(
      choice.cases(), choice.arguments(), 60,
      [&](const verify::CheckResults&) { EXPECT_LE(++found, reached); },
      [&](std::size_t count) { reached = count; });
  set_helper_program("");
  EXPECT_EQ(reached, choice.cases().size());
}

/// Outcome of `clpv check` with another file kernels/sizes.cl.
test::Outcome check_with_sizes(const std::string& text, const std::string& arguments) {
  const test::TemporaryFolder folder;
  folder.write("sizes.cl", text);
  return test::run("CLPV_KERNEL_DIR=" + folder.path().string() +
                   " " CLPV_PROGRAM " check --format json " + arguments);
}

/// Status of each result, and the reason of stage `sizes`.
std::map<std::string, std::string> statuses(const test::Outcome& outcome) {
  std::map<std::string, std::string> all;
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  for (const nlohmann::json& check : report.at("checks")) {
    all[check.at("variant")] = check.at("status");
    if (check.at("stage") == "sizes") all["reason"] = check.at("reason");
  }
  EXPECT_FALSE(report.at("passed").get<bool>());
  EXPECT_EQ(report.at("counts").at("failed"),
            std::ranges::count(all, "failed", [](const auto& e) { return e.second; }));
  return all;
}

TEST(Check, AKernelThatDoesNotCompileOrCrashesFailsOnlyItsRow) {
  const std::string broken = "#error broken for a test\n",
                    crashing =
                        "__kernel void sizes(__global uint* bytes) { "
                        "*(volatile __global uint*)(size_t)16 = *bytes; }\n";
  for (const auto& [text, stages, reason] :
       {std::tuple{broken, "sizes,emit", "broken for a test"},  // in helpers
        {broken, "sizes", "broken for a test"},                 // in the process itself
        {crashing, "sizes,emit", "signal 11"}}) {
    const test::Outcome outcome = check_with_sizes(text, std::string("--stage ") + stages);
    EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
    auto all = statuses(outcome);
    EXPECT_EQ(all["shared structs"], "failed");
    EXPECT_THAT(all["reason"], HasSubstr(reason));
    for (const char* row : {"plain", "textures and holes"})
      EXPECT_EQ(all[row], stages == std::string("sizes") ? "" : "ok");
    EXPECT_THAT(outcome.err, HasSubstr("1 failed"));
  }
}

TEST(Check, AKernelThatDoesNotEndExceedsTheLimit) {
  const test::Outcome outcome = check_with_sizes(
      "__kernel void sizes(volatile __global uint* bytes) { do *bytes = 0; while (*bytes == 0); "
      "}\n",
      "--stage sizes,emit --limit 1");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  auto all = statuses(outcome);
  EXPECT_EQ(all["shared structs"], "failed");
  EXPECT_EQ(all["reason"], "took more than --limit 1 s");
  EXPECT_TRUE(all.contains("plain") && all.contains("textures and holes"))
      << "or over the limit too, if compiled";
}

TEST(Check, UnsupportedComparisonsAreNoPass) {
  using verify::CheckResult, verify::Status;
  const verify::Case lacking{Stage::gather, "images", [](Session&) -> verify::CheckResults {
                               throw Error(ExitCode::device, "no images");
                             }};
  Session session(choose_device());
  const verify::CheckResults results = verify::run_case(lacking, session);
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].status, Status::unsupported);
  EXPECT_EQ(results[0].reason, "no images");
  EXPECT_FALSE(verify::passed(results));
  EXPECT_TRUE(verify::passed({results[0], CheckResult{"gather", "plain"}}))
      << "if another one is ok";
  EXPECT_FALSE(verify::passed({{"gather", "plain"}, {"gather", "half", {1, 0.1}, Status::wrong}}));
}

TEST(Check, APresetsCombination) {
  const test::Outcome outcome = test::run(CLPV_PROGRAM " check --preset paper --format json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  std::vector<std::string> rows;
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  for (const nlohmann::json& check : report.at("checks"))
    rows.push_back(check.at("stage").get<std::string>() + " " +
                   check.at("variant").get<std::string>());
  EXPECT_THAT(rows, ::testing::ElementsAre("inject paper/srbf8v2/image/half/light",
                                           "inject paper/srbf8v2/image/half/geometry",
                                           "propagate paper/srbf8v2/image/half",
                                           "gather paper/srbf8v2/image/half"));
}

TEST(Check, ListsAndSelects) {
  const test::Outcome all = test::run(CLPV_PROGRAM " -q check --list --stage propagate,gather"),
                      some = test::run(
                          CLPV_PROGRAM
                          " -q check --list --stage propagate,gather --match tiled --match half"),
                      thorough = test::run(CLPV_PROGRAM
                                           " -q check --list --thorough --stage propagate,gather"),
                      none = test::run(CLPV_PROGRAM " -q check --stage shade --match srbf99");
  EXPECT_THAT(all.out, HasSubstr("propagate  sh2/sampled/"));
  EXPECT_THAT(some.out, HasSubstr("tiled/half"));
  EXPECT_LT(some.out.size(), all.out.size());
  EXPECT_LT(all.out.size(), thorough.out.size());
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("--match srbf99"));
}

}  // namespace clpv::helpers_test
