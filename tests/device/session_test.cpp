// SPDX-License-Identifier: MIT
// A device in use: memory it rejects, launches of any size, times by events and by the host's
// clock, shared structs.
#include "device/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "device/kernel.hpp"
#include "device/prefix_sum.hpp"
#include "tests/support/error_of.hpp"
#include "verify/check.hpp"

namespace clpv::session_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Session, RejectsABufferTheDeviceCannotHoldWithItsLimit) {
  Device device = choose_device();
  device.max_alloc_bytes = 4u << 20;
  device.memory_bytes = 6u << 20;
  Session session(device);
  const Buffer held = session.buffer(4u << 20, "first");
  EXPECT_EQ(session.largest_buffer(), 2u << 20);
  EXPECT_THAT(test::error_of(ExitCode::run_time, [&] { session.buffer(3u << 20, "light volume"); }),
              AllOf(HasSubstr("light volume needs 3.0 MiB"), HasSubstr("at most 2.0 MiB")));
  EXPECT_EQ(session.device_bytes(), 4u << 20) << "rejected buffers do not count";
}

TEST(Session, WhatWasEnqueuedIsDoneWhenItEnds) {
  std::vector<cl::Event> events(8);
  {
    Session session(choose_device());
    const Buffer buffer = session.buffer(64u << 20, "filled again and again");
    for (cl::Event& event : events)
      session.queue().enqueueFillBuffer(buffer.handle(), cl_uint{7}, 0, buffer.bytes(), nullptr,
                                        &event);
  }
  for (const cl::Event& event : events)
    EXPECT_EQ(event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_COMPLETE);
}

TEST(Session, FreedBuffersReleaseMemory) {
  Device device = choose_device();
  device.memory_bytes = 6u << 20;
  Session session(device);
  for (int i = 0; i < 8; ++i) {
    const Buffer made = session.buffer(4u << 20, "one of many");
    const Buffer same = made;
    session.fill_zero(same, same.bytes());
    EXPECT_EQ(session.device_bytes(), 4u << 20) << "a copy is the same memory";
    EXPECT_THROW(session.buffer(4u << 20, "beside it"), Error);
  }
  EXPECT_EQ(session.device_bytes(), 0u);
  EXPECT_EQ(session.peak_device_bytes(), 4u << 20);
}

TEST(Session, ABufferGrowsWhereThereIsNoRoomForTwo) {
  Device device = choose_device();
  device.memory_bytes = 6u << 20;
  Session session(device);
  Buffer buffer;
  session.reserve(buffer, 3u << 20, "grows");
  session.reserve(buffer, 5u << 20, "grows");
  EXPECT_EQ(session.device_bytes(), 5u << 20);
  session.reserve(buffer, 1u << 20, "stays");
  EXPECT_EQ(buffer.bytes(), 5u << 20);
}

TEST(Session, CommandsThatTheDriverRefusesAreNamed) {
  Session session(choose_device());
  const std::size_t room = 1024, more = 4 * room;
  Buffer buffer = session.buffer(room, "small"), large = session.buffer(more, "large");
  const std::vector<char> bytes(more);
  const auto error = [](const auto& command) {
    return test::error_of(ExitCode::run_time, command);
  };
  EXPECT_THAT(error([&] { session.write(buffer, bytes); }), HasSubstr("clEnqueueWriteBuffer"));
  EXPECT_THAT(error([&] { session.read<char>(buffer, more); }), HasSubstr("clEnqueueReadBuffer"));
  EXPECT_THAT(error([&] { session.read_later(buffer, more); }), HasSubstr("clEnqueueReadBuffer"));
  if (session.device().oclgrind()) return;  // kernels fill and copy there
  EXPECT_THAT(error([&] { session.fill_zero(buffer, more); }), HasSubstr("clEnqueueFillBuffer"));
  EXPECT_THAT(error([&] { session.copy(large, buffer, more); }), HasSubstr("clEnqueueCopyBuffer"));
}

TEST(Session, MemoryMayOutliveItsSession) {
  Buffer buffer;
  {
    Session session(choose_device());
    buffer = session.buffer(4, "kept");
  }
  EXPECT_EQ(buffer.bytes(), 4u);
}

TEST(Kernel, MissingArgumentsAreReported) {
  Session session(choose_device());
  const Buffer bytes = session.buffer(1024, "sizes");
  Kernel kernel(session, {"sizes.cl"}, "sizes");
  EXPECT_EQ(session.programs().build_ms(), 0) << "described, not built";
  kernel.set(bytes).launch(1, 1);
  EXPECT_THAT([&] { kernel.set().launch(1, 1); },
              ThrowsMessage<Error>(HasSubstr("kernel 'sizes' was given 0 of its 1 arguments")));
}

TEST(Kernel, ADescribedProgramIsBuiltOnce) {
  Session session(choose_device());
  { const Kernel gone(session, {"sizes.cl", Literals().flag("CLPV_GONE", true)}, "sizes"); }
  session.programs().build_described();
  EXPECT_EQ(session.programs().build_ms(), 0) << "nobody holds it";
  const Kernel kernel(session, {"sizes.cl"}, "sizes");
  session.programs().build_described();
  const double built = session.programs().build_ms();
  EXPECT_GT(built, 0);
  const Kernel again(session, {"sizes.cl"}, "sizes");
  session.programs().build_described();
  EXPECT_EQ(session.programs().build_ms(), built);
}

TEST(Session, ProgramsOfAnEarlierSessionAreNotBuiltAgain) {
  const ProgramSource source("sizes.cl", Literals().flag("CLPV_SHARED", true));
  cl::Program built[2];
  for (cl::Program& each : built) {
    Session session(choose_device());
    const std::shared_ptr<Program> program = session.programs().describe(source);
    session.programs().build_described();
    each = program->built;
  }
  EXPECT_NE(built[0](), nullptr);
  EXPECT_EQ(built[0](), built[1]());
}

TEST(Session, WorkGroupsAboveTheDevicesAreUnsupported) {
  Session session(choose_device());
  const Buffer bytes = session.buffer(1024, "sizes");
  Kernel kernel(session, {"sizes.cl"}, "sizes");
  const std::size_t too_large = 1u << 20;
  EXPECT_THAT(
      test::error_of(ExitCode::device, [&] { kernel.set(bytes).launch(too_large, too_large); }),
      AllOf(HasSubstr("kernel 'sizes' on " + session.device().name + ": found work-groups of"),
            HasSubstr("allowed: 1048576")));
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
      const StageScope inject(session, {Pass::inject_light, 0});
      session.fill_zero(buffer, bytes);
    }
    {
      const StageScope inject(session, {Pass::inject_light, 1});
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

TEST(Session, KernelsHaveTheTimeOfTheirStage) {
  Session session(choose_device());
  const Buffer numbers = session.upload(std::vector<cl_uint>(5000, 1), "numbers"),
               total = session.buffer(sizeof(cl_uint), "total");
  PrefixSum sums(session);
  session.timeline().clear();
  {
    const StageScope gather(session, {Pass::gather});
    session.fill_zero(numbers, 64);
    for (int i = 0; i < 3; ++i) sums.run(numbers, 4000, total);
  }
  {
    const StageScope shade(session, {Pass::shade});
    session.fill_zero(numbers, 64);
  }
  const std::vector<KernelTime> kernels = session.timeline().kernel_times();
  ASSERT_EQ(kernels.size(), 4u);
  EXPECT_EQ(kernels[0].kernel, "fill and copy");
  EXPECT_EQ(kernels[1].kernel, "sum_blocks");
  EXPECT_EQ(kernels[1].launches, 3u);
  EXPECT_EQ(kernels[2].kernel, "place_blocks");
  EXPECT_EQ(kernels[3].mark, (StageMark{Pass::shade}));
  const auto stages = session.timeline().times();
  EXPECT_NEAR(kernels[0].ms + kernels[1].ms + kernels[2].ms, stages[0].ms, 1e-9);
  EXPECT_GT(kernels[1].ms, 0);
}

// Both widths: one work-item a block, and 64 of them.
TEST(PrefixSums, AreThoseOfTheHost) {
  for (const int lanes : {8, 1}) {
    Device device = choose_device();
    device.lanes = lanes;
    Session session(device);
    PrefixSum sums(session);
    for (const std::size_t count : {1u, 15u, 16u, 1023u, 1024u, 1025u, 70000u, 300000u}) {
      std::vector<cl_uint> values(count + 1), expected(count + 1);
      for (std::size_t i = 0; i <= count; ++i) values[i] = (i * 2654435761u) >> 27;
      std::exclusive_scan(values.begin(), values.end(), expected.begin(), 0u);
      const Buffer buffer = session.upload(values, "numbers"),
                   total = session.buffer(sizeof(cl_uint), "total");
      sums.run(buffer, count, total);
      EXPECT_EQ(session.read<cl_uint>(buffer, count + 1), expected) << count << ", " << lanes;
      EXPECT_EQ(session.read<cl_uint>(total, 1)[0], expected[count]);
    }
  }
}

TEST(Session, LaunchesAndWaitsOfAFrameAreCounted) {
  Session session(choose_device());
  const Buffer large = session.buffer(4u << 20, "large");
  session.timeline().clear();
  session.fill_zero(large, 64);
  session.copy(large, large, 64, 128);
  session.write(large, std::vector<float>(100));
  const auto later = session.read_later(large, 3);
  EXPECT_EQ(session.timeline().host().launches, 2u);
  EXPECT_EQ(session.timeline().host().waits, 0u) << "small writes and later reads do not wait";
  session.write(large, std::vector<float>(1u << 20));
  session.read<float>(large, 4);
  session.timeline().enqueued();
  const HostWork host = session.timeline().host();
  EXPECT_EQ(host.waits, 2u);
  EXPECT_GT(host.waited_ms, 0);
  EXPECT_GT(host.host_ms, 0);
  EXPECT_TRUE(later->arrived()) << "before the read that waited";
  EXPECT_EQ(later->values, std::vector<cl_uint>(3));
  session.timeline().clear();
  EXPECT_EQ(session.timeline().host().waits, 0u);
}

}  // namespace
}  // namespace clpv::session_test
