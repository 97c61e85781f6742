// A device in use: memory it refuses, launches of any size, times by events and by the host's clock, shared
// structs.
#include "device/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reference/check.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

using ::testing::HasSubstr;

TEST(Session, RefusesABufferTheDeviceCannotHoldAndSaysWhatFits) {
  Device device = choose_device();
  device.max_alloc_bytes = 4u << 20;
  device.memory_bytes = 6u << 20;
  Session session(device);
  const Buffer held = session.buffer(4u << 20, "first");
  EXPECT_EQ(session.largest_buffer(), 2u << 20);
  try {
    session.buffer(3u << 20, "light volume");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::run_time);
    EXPECT_THAT(error.what(), HasSubstr("light volume needs 3.0 MiB"));
    EXPECT_THAT(error.what(), HasSubstr("at most 2.0 MiB"));
  }
  EXPECT_EQ(session.device_bytes(), 4u << 20) << "what was refused does not count";
}

TEST(Session, EmptyUploadsAndReadsAreFine) {
  Session session(choose_device());
  const Buffer buffer = session.upload(std::vector<float>{}, "nothing");
  EXPECT_TRUE(session.read<float>(buffer, 0).empty());
}

TEST(Session, ImpossibleLaunchNamesKernelAndCode) {
  Session session(choose_device());
  const Buffer bytes = session.buffer(1024, "sizes");
  Kernel kernel(session, {"sizes.cl", {}, {}}, "sizes");
  const std::size_t too_large = 1u << 20;
  try {
    kernel.set(bytes).launch(too_large, too_large);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::run_time);
    EXPECT_THAT(error.what(), HasSubstr("kernel 'sizes' on " + session.device().name));
    EXPECT_THAT(error.what(), HasSubstr("CL_INVALID_WORK_"));
  }
}

TEST(Session, StagesAreTimedAndAddUpByMark) {
  for (const bool events : {true, false}) {
    Device device = choose_device();
    if (events && !device.profiling_valid) continue;
    device.profiling_valid = events;
    Session session(device);
    const std::size_t bytes = 8u << 20;
    const Buffer buffer = session.buffer(bytes, "filled");
    for (int i = 0; i < 2; ++i) {
      const StageScope inject(session, {"inject", 0});
      session.fill_zero(buffer, bytes);
    }
    {
      const StageScope inject(session, {"inject", 1});
      session.fill_zero(buffer, bytes);
    }
    const auto times = session.timeline().times();
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].mark.cascade, 0);
    for (const StageTime& time : times) {
      EXPECT_EQ(time.from_events, events);
      EXPECT_GT(time.ms, 0.01) << "8 MiB in 10 us would be 800 GB/s";
      EXPECT_LT(time.ms, 60e3);
    }
  }
}

TEST(Sizes, HostAndDeviceAgreeOnTheSharedStructs) {
  Session session(choose_device());
  for (const auto& result : reference::check_sizes(session)) EXPECT_TRUE(result.passed()) << result.place;
}

}  // namespace
}  // namespace clpv
