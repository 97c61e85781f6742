// SPDX-License-Identifier: MIT
// Comparisons as test cases, and what the installation takes from the options: man page and completion.
#include "checks/junit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run_program.hpp"

namespace clpv {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Junit, TellsStagesCasesAndWhatFailed) {
  const std::string xml = reference::junit({{"inject", "sh2", 1e-7, 1e-6, ""},
                                            {"gather", "a<b", 0.5, 1e-6, "cell \"1\" & more"},
                                            {"gather", "nan", NAN, 1e-6, "cell 2"}},
                                           "A & B");
  EXPECT_THAT(xml,
              AllOf(HasSubstr("<testsuites name=\"clpv check on A &amp; B\" tests=\"3\" failures=\"2\">"),
                    HasSubstr("<testsuite name=\"inject\" tests=\"1\" failures=\"0\">"),
                    HasSubstr("<testsuite name=\"gather\" tests=\"2\" failures=\"2\">"),
                    HasSubstr("<testcase classname=\"clpv.inject\" name=\"sh2\"/>"),
                    HasSubstr("name=\"a&lt;b\">"), HasSubstr("cell &quot;1&quot; &amp; more</failure>")));
}

TEST(Junit, IsWrittenByTheCheck) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "check.xml").string();
  const test::Outcome outcome = test::run(CLPV_PROGRAM " check --stage sizes --junit " + file);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(test::read_file(file), HasSubstr("<testsuite name=\"sizes\""));
}

TEST(Pages, TheManPageNamesEveryCommandAndOption) {
  const test::Outcome page = test::run(CLPV_PROGRAM " --man-page");
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_THAT(page.out, AllOf(HasSubstr(".TH CLPV 1"), HasSubstr(".SS render"), HasSubstr(".SS bench"),
                              HasSubstr("\\fB\\-\\-transport\\fR"), HasSubstr("Exit codes: 0 ok")));
  EXPECT_THAT(page.out, Not(HasSubstr("man\\-page")));
  const test::Outcome read =
      test::run(CLPV_PROGRAM " --man-page | man -l - 2>&1 >/dev/null | grep -v 'break line'; true");
  EXPECT_THAT(read.out + read.err, Not(HasSubstr("warning"))) << "of roff, where there is a man";
}

TEST(Pages, TheCompletionCompletes) {
  const auto completed = [](const std::string& line) {
    return test::run("bash -c 'source <(" CLPV_PROGRAM " --bash-completion); COMP_WORDS=(" + line +
                     "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _clpv; echo ${COMPREPLY[*]}'")
        .out;
  };
  EXPECT_EQ(completed("clpv seq"), "sequence\n");
  EXPECT_EQ(completed("clpv render --transp"), "--transport\n");
  EXPECT_EQ(completed("clpv render --layout ti"), "tiled\n");
  EXPECT_EQ(completed("clpv bench reg"), "\n");
}

}  // namespace
}  // namespace clpv
