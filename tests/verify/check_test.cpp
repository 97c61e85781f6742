// SPDX-License-Identifier: MIT
// Kernels against the CPU reference, stage by stage, as `clpv check` compares them.
#include "verify/check.hpp"

#include <gtest/gtest.h>

#include "tests/support/on_device.hpp"

namespace clpv::check_test {
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
// compared here: tests/support/helpers_test.cpp compares the published scheme,
// tests/volume/volume_test.cpp stores and loads all formats. LongKernels has the other rows.
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
// tests/oclgrind also run them, on smaller scenes.
TEST(LongCheck, KernelsAgreeInTheOtherNumberOfLanes) {
  Device device = test::test_session().device();
  device.lanes = device.lanes == 8 ? 1 : 8;
  Session session(device);
  for (const Stage stage : {Stage::rasterize, Stage::emit, Stage::reflectors, Stage::visibility,
                            Stage::propagate, Stage::near, Stage::shade})
    expect_agreement(verify::cases_of(stage), session);
}

}  // namespace
}  // namespace clpv::check_test
