// SPDX-License-Identifier: MIT
// What the program says before any command runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/run_program.hpp"

namespace clpv::command_line_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

test::Outcome clpv(const std::string& arguments) {
  return test::run(CLPV_PROGRAM " " + arguments);
}

TEST(CommandLine, NothingGivenIsAQuestionForHelp) {
  const test::Outcome bare = clpv(""), help = clpv("--help");
  EXPECT_EQ(bare.exit_code, 0);
  EXPECT_EQ(bare.out, help.out);
  EXPECT_THAT(bare.out, AllOf(HasSubstr("render"), HasSubstr("Exit codes")));
  EXPECT_EQ(bare.err, "");
}

TEST(CommandLine, AMisspeltCommandIsNamed) {
  const test::Outcome outcome = clpv("--quiet rendr scene.json -o out.png");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("'rendr'"), HasSubstr("did you mean render?")));
  EXPECT_THAT(clpv("qualtiy").err, HasSubstr("did you mean quality?"));
}

TEST(CommandLine, AWordLikeNoCommandGetsTheList) {
  const test::Outcome outcome = clpv("photograph");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("'photograph'"), HasSubstr("render"), HasSubstr("compare"),
                                 Not(HasSubstr("did you mean"))));
}

TEST(CommandLine, OptionsWithoutACommandAreAnError) {
  const test::Outcome outcome = clpv("--quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("subcommand"));
}

TEST(CommandLine, TimesAreFiniteSeconds) {
  for (const std::string command : {"render", "reference"}) {
    for (const std::string bad : {"nan", "inf", "1e7", "noon", "1s", "''"}) {
      const test::Outcome outcome = clpv(command + " none.gltf -o none.exr --time " + bad);
      EXPECT_EQ(outcome.exit_code, 2) << bad;
      EXPECT_THAT(outcome.err, AllOf(HasSubstr("--time"), HasSubstr("-1000000..1000000"))) << bad;
    }
  }
}

}  // namespace
}  // namespace clpv::command_line_test
