// SPDX-License-Identifier: MIT
// A device in use: memory it rejects, launches of any size, times by events and by the host's
// clock, shared structs.

#include "device/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "device/cl_error.hpp"
#include "device/device.hpp"
#include "device/kernel.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"
#include "verify/check.hpp"

namespace clpv::session_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

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
  Buffer buffer;
  for (const std::size_t bytes : {3u << 20, 5u << 20, 1u << 20})
    session.reserve(buffer, bytes, "grows where there is no room for two");
  EXPECT_EQ(buffer.bytes(), 5u << 20);
  EXPECT_EQ(session.device_bytes(), 5u << 20);
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
  EXPECT_THAT(
      [&] { kernel.set().launch(1, 1); },
      testing::ThrowsMessage<Error>(HasSubstr("kernel 'sizes' was given 0 of its 1 arguments")));
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

// Listing and choosing devices, on synthetic lists and on this machine's list.

Device made_up(int index, int platform, int in_platform, const std::string& name) {
  Device device;
  device.index = index;
  device.platform_index = platform;
  device.device_index = in_platform;
  device.name = name;
  device.platform = platform == 0 ? "First Platform" : "Third Platform";
  return device;
}

/// Platform 1 has no device, so indices of platforms and of devices differ.
std::vector<Device> three_devices() {
  std::vector<Device> devices = {made_up(0, 0, 0, "Small CPU"), made_up(1, 2, 0, "Big GPU"),
                                 made_up(2, 2, 1, "Old GPU")};
  devices[2].missing = {"OpenCL 1.2", "compiler"};
  return devices;
}

TEST(ChooseDevice, ByIndexPairAndPartOfAName) {
  const auto devices = three_devices();
  EXPECT_EQ(choose_device(devices, "1").name, "Big GPU");
  EXPECT_EQ(choose_device(devices, "2:0").name, "Big GPU");
  EXPECT_EQ(choose_device(devices, "0:0").name, "Small CPU");
  EXPECT_EQ(choose_device(devices, "big").name, "Big GPU");
  EXPECT_EQ(choose_device(devices, "first plat").name, "Small CPU");
}

TEST(ChooseDevice, WithoutAChoiceTakesTheFirstSupportedOne) {
  auto devices = three_devices();
  devices[0].missing = {"available"};
  EXPECT_EQ(choose_device(devices, "").name, "Big GPU");
}

TEST(ChooseDevice, RejectsWithTheReason) {
  const auto devices = three_devices();
  const auto rejected = [](const std::vector<Device>& of, const char* choice) {
    return test::error_of(ExitCode::device, [&] { choose_device(of, choice); });
  };
  EXPECT_THAT(rejected(devices, "7"),
              AllOf(HasSubstr("'7'"), HasSubstr("1: Big GPU (Third Platform)")));
  rejected(devices, "1:0");  // a platform without devices
  EXPECT_THAT(rejected(devices, "gpu"), HasSubstr("several"));
  EXPECT_THAT(rejected(devices, "old"), HasSubstr("OpenCL 1.2, compiler"));
  EXPECT_THAT(rejected({}, ""), HasSubstr("apt install"));
  EXPECT_THAT(rejected({devices[2]}, ""), HasSubstr("no supported"));
}

TEST(DevicesCommand, JsonHasTheDocumentedKeys) {
  const auto outcome = test::run_here("devices --format json --device 0");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("schema"), 1);
  EXPECT_TRUE(json.at("platforms_without_devices").is_array());
  ASSERT_EQ(json.at("devices").size(), 1u);
  std::vector<std::string> keys;
  for (const auto& [key, value] : json["devices"][0].items()) keys.push_back(key);
  EXPECT_THAT(keys, ::testing::UnorderedElementsAre(
                        "index", "platform_index", "device_index", "platform", "name", "driver",
                        "version", "type", "compute_units", "max_work_group_size",
                        "max_alloc_bytes", "images", "image3d_writes", "int64_atomics", "fp64",
                        "profiling_valid", "supported", "missing"));
}

TEST(DevicesCommand, WithoutDriversIsAnEmptyListAndAMessage) {
  const test::TemporaryFolder empty;
  const std::string none = "OCL_ICD_VENDORS=" + empty.path().string() + " ";
  const auto listed = test::run(none + CLPV_PROGRAM " devices --format json");
  EXPECT_EQ(listed.exit_code, 4);
  EXPECT_TRUE(nlohmann::json::parse(listed.out).at("devices").empty());
  EXPECT_THAT(listed.err, HasSubstr("no OpenCL device found by OCL_ICD_VENDORS=/"));
  const auto asked = test::run(none + CLPV_PROGRAM " devices --device 0");
  EXPECT_EQ(asked.exit_code, static_cast<int>(ExitCode::device));
  EXPECT_EQ(asked.out, "");
}

TEST(DeviceClock, AtFaultGivesWayToTheHosts) {
  const test::TemporaryFolder folder;
  const std::pair<std::string, std::string> faults[] = {
      {"ticks", "events have no plausible times: those of stages are the host's"},
      {"short", "events have no plausible times: those of stages are the host's"},
      {"late", "take far less time than the host waits for them: times of stages are the host's"},
      {"swap", "events end before they start: times of stages are the host's"},
      {"still", "events take no time: times of stages are the host's"}};
  for (const auto& [fault, said] : faults) {
    const auto outcome =
        test::run("LD_PRELOAD=" CLPV_OPENCL_SHIM " CLPV_SHIM_CLOCK=" + fault +
                  " " CLPV_PROGRAM " render " CLPV_SOURCE_DIR
                  "/scenes/cornell.json --width 32 --height 18 --frames 1 --stats - -o " +
                  (folder / "a.exr").string());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(said));
    const auto stats = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(stats["timer"], "wall") << fault;
    double sum = 0;
    for (const auto& time : stats["times"])
      if (time["stage"] != "frame" && time["stage"] != "host") sum += time["min"].get<double>();
    EXPECT_LE(sum, stats["times"][0]["max"].get<double>()) << fault;
    EXPECT_GT(sum, 0) << fault;
  }
}

TEST(ClError, NamesCodeCallAndAdvice) {
  EXPECT_EQ(cl_error_name(CL_OUT_OF_RESOURCES), "CL_OUT_OF_RESOURCES (-5)");
  EXPECT_EQ(cl_error_name(-12345), "code -12345");
  const Error memory =
      cl_error(cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE, "clEnqueueNDRangeKernel"), "kernel 'x'");
  EXPECT_EQ(memory.code(), ExitCode::run_time);
  EXPECT_THAT(
      memory.what(),
      HasSubstr(
          "kernel 'x': clEnqueueNDRangeKernel failed with CL_MEM_OBJECT_ALLOCATION_FAILURE (-4)"));
  EXPECT_THAT(memory.what(), HasSubstr("smaller grid"));
  EXPECT_EQ(cl_error(cl::Error(CL_DEVICE_NOT_FOUND, "clGetDeviceIDs")).code(), ExitCode::device);
}

// `clpv devices` names drivers that cannot be loaded, and lists the others.

struct DriverFiles : ::testing::Test {
  /// An .icd file with the library of that name in the folder, or elsewhere.
  void add(const std::string& icd, const std::string& library) {
    folder_.write("vendors/" + icd, library + "\n");
  }
  test::Outcome devices(const std::string& more = {}) const {
    return test::run("OCL_ICD_VENDORS=" + (folder_ / "vendors").string() +
                     " timeout 60 " CLPV_PROGRAM " devices " + more);
  }
  /// A library with this code.
  std::string library(const std::string& name, const std::string& code) {
    const std::string file = (folder_ / name).string();
    const auto source = folder_.write(name + ".c", code);
    const test::Outcome built = test::run("cc -shared -o " + file + " " + source.string());
    EXPECT_EQ(built.exit_code, 0) << built.err;
    return file;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(DriverFiles, ThatAreMissingOrForeignAreNamed) {
  add("1-missing.icd", "/nonexistent/libmissing.so");
  add("3-text.icd", folder_.write("text.so", "no library").string());
  add("4-empty.icd", "");
  add("5-unknown.icd", "libclpv-none.so.7");
  add("8-other.icd", "libc.so.6");
  const test::Outcome outcome = devices();
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_THAT(
      outcome.out,
      AllOf(HasSubstr("/nonexistent/libmissing.so: cannot open shared object file"),
            HasSubstr("text.so: file too short"), HasSubstr("4-empty.icd: names no library\n"),
            HasSubstr("libclpv-none.so.7: cannot open shared object file"),
            HasSubstr("libc.so.6: offers no OpenCL platform\n")));
}

TEST_F(DriverFiles, ThatEndTheProcessAreNamedAndTheOthersListed) {
  for (const auto& entry : std::filesystem::directory_iterator("/etc/OpenCL/vendors"))
    if (entry.path().filename() == "pocl.icd") add("pocl.icd", test::read_file(entry.path()));
  if (!std::filesystem::exists(folder_ / "vendors/pocl.icd"))
    GTEST_SKIP() << "no pocl.icd (Debian: apt install pocl-opencl-icd)";
  add("aborts.icd", library("aborts.so",
                            "#include <stdlib.h>\n"
                            "__attribute__((constructor)) static void start(void) { abort(); }\n"));
  add("exits.icd", library("exits.so",
                           "#include <unistd.h>\n"
                           "__attribute__((constructor)) static void start(void) { _exit(0); }\n"));
  // The loader would wait for a writer.
  ASSERT_EQ(::mkfifo((folder_ / "vendors/pipe.icd").c_str(), 0600), 0);
  const test::Outcome outcome = devices();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("Portable Computing Language"), HasSubstr("aborts.icd: "),
                    HasSubstr("signal 6"), HasSubstr("exits.icd: "),
                    HasSubstr("with exit code 0 when loaded"),
                    HasSubstr("pipe.icd: names no library"), testing::Not(HasSubstr("pocl.icd"))));
  EXPECT_THAT(devices("--format json").out,
              AllOf(HasSubstr("\"faulty_drivers\": [\n"), HasSubstr("aborts.icd")));
}

}  // namespace clpv::session_test
