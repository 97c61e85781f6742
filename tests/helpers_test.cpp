// SPDX-License-Identifier: MIT
// Helper processes: each job is taken once, and with their help a first run gives the same image
// and the same checks.
#include "support/helpers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "support/error.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::helpers_test {
namespace {

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

TEST(Claims, FinishedJobsHaveResults) {
  const test::TemporaryFolder folder;
  const Claims claims(folder.path());
  EXPECT_TRUE(claims.take("a"));
  EXPECT_FALSE(claims.finished("a"));
  claims.finish("a", "result");
  EXPECT_TRUE(claims.finished("a"));
  EXPECT_EQ(claims.result("a"), "result");
  EXPECT_EQ(claims.finished_count(), 1u);
}

TEST(Helpers, ALibraryHasNone) {
  EXPECT_EQ(helper_count(), 0u) << "only clpv's main names a program";
}

const std::string kFrame = " -v render " CLPV_SOURCE_DIR
                           "/tests/oclgrind/tiny.gltf --grid 5 --cascades 1 --cascade-size 5 --rsm-size 8 "
                           "--shadow-size 8 --width 24 --height 18 -o ";

/// The variables of empty caches in that folder.
std::string caches(const fs::path& folder) {
  fs::create_directories(folder / "pocl");
  return "XDG_CACHE_HOME=" + folder.string() + " POCL_CACHE_DIR=" + (folder / "pocl").string() + " ";
}

TEST(FirstRun, HelpersCompileForTheSameImage) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "helpers need a second core";
  const test::TemporaryFolder folder;
  const std::string first = (folder / "first.exr").string(), second = (folder / "second.exr").string(),
                    alone = (folder / "alone.exr").string();
  const std::string here = caches(folder / "cache");
  const test::Outcome helped = test::run(here + CLPV_PROGRAM + kFrame + first);
  ASSERT_EQ(helped.exit_code, 0) << helped.err;
  EXPECT_THAT(helped.err, ContainsRegex("compiling [0-9]+ kernels for .*: on the first run only"));
  EXPECT_THAT(helped.err, ContainsRegex("helpers compiled [1-9][0-9]* kernels"));
  EXPECT_THAT(helped.err, Not(HasSubstr("a helper failed")));
  EXPECT_THAT(helped.err, Not(HasSubstr("warning")));
  const test::Outcome warm = test::run(here + CLPV_PROGRAM + kFrame + second);
  ASSERT_EQ(warm.exit_code, 0) << warm.err;
  EXPECT_THAT(warm.err, Not(HasSubstr("on the first run only"))) << "all kernels are marked";
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
  const std::string check = CLPV_PROGRAM " check --format json --stage shade,emit,sizes";
  const test::Outcome helped = test::run(check), alone = test::run("taskset -c 0 " + check);
  ASSERT_EQ(helped.exit_code, 0) << helped.err;
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(results_of(helped), results_of(alone));
}

TEST(Check, ListsAndSelects) {
  const test::Outcome all = test::run(CLPV_PROGRAM " -q check --list --stage propagate,gather"),
                      some =
                          test::run(CLPV_PROGRAM
                                    " -q check --list --stage propagate,gather --match tiled --match half"),
                      thorough =
                          test::run(CLPV_PROGRAM " -q check --list --thorough --stage propagate,gather"),
                      none = test::run(CLPV_PROGRAM " -q check --stage shade --match srbf99");
  EXPECT_THAT(all.out, HasSubstr("propagate  sh2/sampled/"));
  EXPECT_THAT(some.out, HasSubstr("tiled/half"));
  EXPECT_LT(some.out.size(), all.out.size());
  EXPECT_LT(all.out.size(), thorough.out.size());
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("--match srbf99"));
}

}  // namespace
}  // namespace clpv::helpers_test
