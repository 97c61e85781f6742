// SPDX-License-Identifier: MIT
// Comparisons as test cases, for what shows test results.
#include "checks/junit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run_here.hpp"

namespace clpv::junit_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

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
  const test::Outcome outcome = test::run_here("check --stage sizes --junit " + file);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(test::read_file(file), HasSubstr("<testsuite name=\"sizes\""));
}

}  // namespace
}  // namespace clpv::junit_test
