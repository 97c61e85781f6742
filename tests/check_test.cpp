// SPDX-License-Identifier: MIT
// Kernels against the CPU reference, stage by stage, as `clpv check` compares them.
#include "verify/check.hpp"

#include <gtest/gtest.h>

#include "tests/support/on_device.hpp"

namespace clpv::check_test {
namespace {

/// Compares all kernels of a stage.
void expect_agreement(Stage stage, Session& session, const verify::CheckScope& scope = {}) {
  const verify::CheckResults results = verify::check(stage, session, scope);
  EXPECT_FALSE(results.empty());
  for (const verify::CheckResult& result : results) {
    const verify::Deviation& found = result.deviation;
    EXPECT_EQ(result.stage, name_of(stage));
    EXPECT_GT(result.seconds, 0) << result.stage << " " << result.variant;
    EXPECT_TRUE(result.passed()) << result.stage << " " << result.variant << ": " << found.worst
                                 << ", allowed " << found.allowed << "; " << found.place
                                 << result.reason;
  }
}

class Kernels : public ::testing::TestWithParam<Stage> {};

INSTANTIATE_TEST_SUITE_P(Check, Kernels, ::testing::ValuesIn(values_of<Stage>()),
                         [](const auto& info) { return std::string(name_of(info.param)); });

// Of the volume formats beside the default only that of the published scheme: building kernels is
// nearly all of the time. tests/volume_test.cpp stores and loads all formats.
TEST_P(Kernels, AgreeWithTheReference) {
  expect_agreement(GetParam(), test::test_session(),
                   {.formats = {{Layout::image, Storage::float16}}});
}

class LongKernels : public Kernels {};

INSTANTIATE_TEST_SUITE_P(LongCheck, LongKernels,
                         ::testing::Values(Stage::inject, Stage::blockers, Stage::reflectors,
                                           Stage::propagate, Stage::sweep, Stage::bounce,
                                           Stage::gather),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST_P(LongKernels, AgreeInEveryVolumeFormat) {
  expect_agreement(GetParam(), test::test_session());
}

// Kernels with the other number of lanes: one on a CPU, as GPUs get them. Workloads of
// tests/oclgrind also run them, on smaller scenes.
TEST(LongCheck, KernelsAgreeInTheOtherNumberOfLanes) {
  Device device = test::test_session().device();
  device.lanes = device.lanes == 8 ? 1 : 8;
  Session session(device);
  for (const Stage stage : {Stage::rasterize, Stage::emit, Stage::reflectors, Stage::visibility,
                            Stage::propagate, Stage::near, Stage::shade})
    expect_agreement(stage, session);
}

}  // namespace
}  // namespace clpv::check_test
