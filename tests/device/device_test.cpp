// SPDX-License-Identifier: MIT
// Listing and choosing devices, on synthetic lists and on this machine's list.
#include "device/device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "device/cl_error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::device_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

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
  EXPECT_THAT(listed.err, HasSubstr("no OpenCL device"));
  const auto asked = test::run(none + CLPV_PROGRAM " devices --device 0");
  EXPECT_EQ(asked.exit_code, static_cast<int>(ExitCode::device));
  EXPECT_EQ(asked.out, "");
}

TEST(DeviceClock, AtFaultGivesWayToTheHosts) {
  const test::TemporaryFolder folder;
  const std::pair<std::string, std::string> faults[] = {
      {"ticks", "events have no plausible times: those of stages are the host's"},
      {"short", "events have no plausible times: those of stages are the host's"},
      {"swap", "events end before they start: times of stages are the host's"},
      {"still", "events take no time: times of stages are the host's"}};
  for (const auto& [fault, said] : faults) {
    const auto outcome =
        test::run("LD_PRELOAD=" CLPV_OPENCL_SHIM " CLPV_SHIM_CLOCK=" + fault +
                  " " CLPV_PROGRAM " render " CLPV_SOURCE_DIR
                  "/scenes/cornell.json --width 32 --height 18 --frames 2 --stats - -o " +
                  (folder / "a.exr").string() + test::kSweepOfOne);
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

}  // namespace
}  // namespace clpv::device_test
