// SPDX-License-Identifier: MIT
// Kernels against the CPU reference, stage by stage, as `clpv check` compares them.

#include "verify/check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "basis/basis.hpp"
#include "reference/inject.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::verify::comparison_test {

namespace {

/// Compares these kernels.
void expect_agreement(const verify::Cases& cases, Session& session) {
  verify::CheckResults results;
  for (const verify::Case& compared : cases) {
    const verify::CheckResults found = verify::run_case(compared, session);
    results.insert(results.end(), found.begin(), found.end());
  }
  EXPECT_FALSE(results.empty());
  for (const verify::CheckResult& result : results) {
    const verify::Deviation& found = result.deviation;
    EXPECT_GT(result.seconds, 0) << result.stage << " " << result.variant;
    EXPECT_TRUE(result.passed()) << result.stage << " " << result.variant << ": " << found.worst
                                 << ", allowed " << found.allowed << "; " << found.place
                                 << result.reason;
  }
}

class Kernels : public ::testing::TestWithParam<Stage> {};

INSTANTIATE_TEST_SUITE_P(Check, Kernels, ::testing::ValuesIn(values_of<Stage>()),
                         [](const auto& info) { return std::string(name_of(info.param)); });

// Building kernels is nearly all of the time. So only the default frame's format and bases are
// compared here: tests/support/helpers_test.cpp compares the published scheme. LongKernels has the
// other rows.
TEST_P(Kernels, AgreeWithTheReference) {
  verify::Cases cases = verify::cases_of(GetParam(), {.formats = {}});
  std::erase_if(cases, [](const verify::Case& compared) {
    return compared.name.starts_with("srbf") || compared.name.starts_with("bins");
  });
  expect_agreement(cases, test::test_session());
}

class LongKernels : public Kernels {};

INSTANTIATE_TEST_SUITE_P(LongCheck, LongKernels,
                         ::testing::Values(Stage::inject, Stage::blockers, Stage::reflectors,
                                           Stage::propagate, Stage::sweep, Stage::bounce,
                                           Stage::gather),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST_P(LongKernels, AgreeInEveryVolumeFormat) {
  expect_agreement(verify::cases_of(GetParam()), test::test_session());
}

// Kernels with the other number of lanes: one on a CPU, as GPUs get them. Workloads of
// lab/tests/oclgrind also run them, on smaller scenes.
TEST(LongCheck, KernelsAgreeInTheOtherNumberOfLanes) {
  Device device = test::test_session().device();
  device.lanes = device.lanes == 8 ? 1 : 8;
  Session session(device);
  for (const Stage stage : {Stage::rasterize, Stage::emit, Stage::reflectors, Stage::visibility,
                            Stage::propagate, Stage::near, Stage::shade})
    expect_agreement(verify::cases_of(stage), session);
}

// Comparison of results with the CPU reference, and its JUnit report.

using ::testing::HasSubstr;

TEST(Comparison, ReportsTheLargestErrorAndItsPlace) {
  std::vector<double> expected(2 * 8, 0.5);
  std::vector<float> found(expected.begin(), expected.end());
  EXPECT_EQ(compare_volumes(found, expected, 2).worst, 0);
  EXPECT_EQ(compare_volumes(found, expected, 2).place, "");
  found[3] = 0.625f;
  found[8 + 6] = 0.25f;
  EXPECT_EQ(compare_volumes(found, expected, 2).worst, 0.5);
  EXPECT_EQ(compare_volumes(found, expected, 2).place, "cell 0,1,1 plane 1: 0.25, expected 0.5");
}

TEST(Comparison, NaNIsWorseThanAnyNumberAndStays) {
  std::vector<double> expected(8, 0.5);
  std::vector<float> found(expected.begin(), expected.end());
  found[2] = NAN;
  found[5] = 1000;
  EXPECT_TRUE(std::isnan(compare_volumes(found, expected, 2).worst));
  EXPECT_THAT(compare_volumes(found, expected, 2).place, HasSubstr("cell 0,1,0"));
}

TEST(Comparison, AReferenceOfNothingAllowsNothing) {
  const std::vector<double> expected(8, 0.0);
  std::vector<float> found(8, 0.0f);
  EXPECT_FALSE(compare_volumes(found, expected, 2).worst <= 1);  // 0 / 0 does not pass
}

TEST(Comparison, EitherOfTwoNearlyEqualBlockersIsRight) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const std::vector<double> up = basis->clamped_cosine({0, 1, 0}),
                            along = basis->clamped_cosine({1, 0, 0});
  reference::Volume a(2, basis->size(), 1), b = a;
  const auto put = [](reference::Volume& to, int x, const std::vector<double>& c, double scale) {
    for (std::size_t i = 0; i < c.size(); ++i)
      to.at(0, static_cast<int>(i), x, 0, 0) = scale * c[i];
  };
  put(a, 0, up, 1), put(b, 0, along, 1.0005);  // as halves may round it
  put(a, 1, up, 1), put(b, 1, along, 1.01);
  reference::Volume merged = a;
  reference::merge_geometry(b, *basis, Blocking::one_sided, merged);
  EXPECT_EQ(merged.values, b.values);
  const reference::Volume other = reference::merged_against_ties(a, b, *basis, Blocking::one_sided);
  for (int i = 0; i < basis->size(); ++i) {
    EXPECT_EQ(other.value(0, i, 0, 0, 0), a.value(0, i, 0, 0, 0));
    EXPECT_EQ(other.value(0, i, 1, 0, 0), b.value(0, i, 1, 0, 0));
  }
}

TEST(Junit, ListsStagesCasesAndFailures) {
  const auto of = [](const char* stage, const char* variant, double worst, const char* place) {
    return result_of(stage, variant, {worst, 1e-6, place});
  };
  const std::string xml = junit({of("inject", "sh2", 1e-7, ""),
                                 of("gather", "a<b", 0.5, "cell \"1\" & more"),
                                 of("gather", "nan", NAN, "cell 2"),
                                 {"gather", "dead", {}, Status::failed, "signal <11>"},
                                 {"gather", "image", {}, Status::unsupported, "no images"}},
                                "A & B");
  EXPECT_THAT(
      xml,
      testing::AllOf(
          HasSubstr("<testsuites name=\"clpv check on A &amp; B\" tests=\"5\" failures=\"2\" "
                    "errors=\"1\" skipped=\"1\">"),
          HasSubstr(
              "<testsuite name=\"inject\" tests=\"1\" failures=\"0\" errors=\"0\" skipped=\"0\">"),
          HasSubstr("<testcase classname=\"clpv.inject\" name=\"sh2\" time=\"0.000000\"/>"),
          HasSubstr("name=\"a&lt;b\" time=\"0.000000\">"),
          HasSubstr("cell &quot;1&quot; &amp; more</failure>"),
          HasSubstr("<error>signal &lt;11></error>"),
          HasSubstr("<skipped message=\"no images\"/>")));
}

TEST(Junit, WithoutAnOkResultItHasAnError) {
  for (const CheckResults& none :
       {CheckResults{}, CheckResults{{"gather", "image", {}, Status::unsupported, "no images"}}})
    EXPECT_THAT(junit(none, "A"), HasSubstr("failures=\"0\" errors=\"1\""));
}

TEST(Junit, IsWrittenByTheCheck) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "check.xml").string();
  const test::Outcome outcome = test::must_run_here("check --stage sizes --junit " + file);
  EXPECT_THAT(test::read_file(file), HasSubstr("<testsuite name=\"sizes\""));
}

}  // namespace
}  // namespace clpv::verify::comparison_test
