// SPDX-License-Identifier: MIT
// Failing devices and full disks: allocations and enqueues of a frame fail in turn (by a shim of
// the OpenCL loader, tests/system/opencl_shim.cpp). Each run ends with a message and exit code 1,
// and leaves no device memory and no file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::starved_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kFrame = " render " + test::kTiny + kSmallSteps;

struct Starved : ::testing::Test {
  static void SetUpTestSuite() {
    cache_ = new TemporaryFolder;
    run(program() + kFrame + "-o " +
        (*cache_ / "first.exr").string());  // compiles, where no test before it did
  }
  static void TearDownTestSuite() { delete cache_; }

  /// Programs are compiled once for all tests, each in its process; the cache lies beside the
  /// program.
  static fs::path compiled() { return fs::path(CLPV_PROGRAM).parent_path() / "starved_cache"; }

  /// `timeout` goes first: only the program gets the shim.
  static std::string program() {
    return "timeout 600 env " + usual_kernels() +
           "CLPV_PROGRAM_CACHE= XDG_CACHE_HOME=" + compiled().string() +
           " CLPV_SHIM_REPORT=" + (*cache_ / "report").string() +
           " LD_PRELOAD=" CLPV_OPENCL_SHIM " " CLPV_PROGRAM;
  }

  /// Calls by name, and "live".
  static std::map<std::string, long> report() {
    std::istringstream in(read_file(*cache_ / "report"));
    std::map<std::string, long> counts;
    std::string name;
    for (long count = 0; in >> name >> count;) counts[name] = count;
    return counts;
  }

  /// A frame whose n-th call fails with a code, whose name must be said.
  void expect_reported(const std::string& call, long n, const std::string& code,
                       const std::string& name) {
    SCOPED_TRACE(call + " " + std::to_string(n));
    const fs::path image = folder_ / "a.exr";
    const Outcome outcome = run("CLPV_SHIM=" + call + ":" + std::to_string(n) + ":" + code + " " +
                                program() + kFrame + "-o " + image.string());
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(name));
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("terminate")));
    EXPECT_FALSE(fs::exists(image));
    EXPECT_EQ(report()["live"], 0) << "memory objects left";
  }

  /// Each `step`-th call of a frame in turn; CLPV_STARVED_STEP replaces the step (1: every call).
  void expect_reported_at_some(const std::string& call, long step, const std::string& code,
                               const std::string& name) {
    const Outcome sound = run(program() + kFrame + "-o " + (folder_ / "sound.exr").string());
    ASSERT_EQ(sound.exit_code, 0) << sound.err;
    ASSERT_EQ(report()["live"], 0);
    const long count = report()[call];
    ASSERT_GT(count, 1);
    if (const char* wish = std::getenv("CLPV_STARVED_STEP")) step = std::max(1, std::atoi(wish));
    // The first buffers ask whether the clock of events is to be trusted (device.cpp); their
    // failure is an answer.
    for (long n = 3; n <= count; n += step) expect_reported(call, n, code, name);
  }

  TemporaryFolder folder_;
  static TemporaryFolder* cache_;
};

TemporaryFolder* Starved::cache_ = nullptr;

TEST_F(Starved, OfDeviceMemoryAtSomeAllocations) {
  expect_reported_at_some("memory", 47, "-4", "CL_MEM_OBJECT_ALLOCATION_FAILURE");
}

TEST_F(Starved, OfItsDeviceAtSomeEnqueues) {
  expect_reported_at_some("enqueue", 41, "-2", "CL_DEVICE_NOT_AVAILABLE");
}

TEST_F(Starved, OfItsDeviceAtTheStart) {
  expect_reported("context", 2, "-2", "CL_DEVICE_NOT_AVAILABLE");
}

// PoCL 3.1 fails so now and then.
TEST_F(Starved, OfACompilerOnceItIsTriedAgain) {
  const fs::path image = folder_ / "a.exr";
  const Outcome once = run("CLPV_SHIM=clBuildProgram:3:-11 LD_PRELOAD=" CLPV_OPENCL_SHIM
                           " timeout 600 " CLPV_PROGRAM +
                           kFrame + "-o " + image.string());
  EXPECT_EQ(once.exit_code, 0) << once.err;
  EXPECT_TRUE(fs::exists(image));
}

// SIGXFSZ once ended the program without a word.
TEST_F(Starved, OfRoomForItsFile) {
  const fs::path image = folder_.write("a.exr", "old");
  const Outcome outcome =
      run("ulimit -c 0; ulimit -f 16 && " CLPV_PROGRAM " pathtrace " + test::kTiny +
          " --width 120 --height 90 --spp 1 -o " + image.string());
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("a.exr: cannot be written: File too large"));
  EXPECT_EQ(read_file(image), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing beside it";
}

}  // namespace
}  // namespace clpv::test::starved_test
