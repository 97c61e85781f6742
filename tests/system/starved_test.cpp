// SPDX-License-Identifier: MIT
// Failing devices and full disks: allocations, enqueues and builds of a frame fail in turn (by a
// shim of the OpenCL loader, tests/system/opencl_shim.cpp). Each run ends with a message and exit
// code 1, and leaves no device memory and no file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "pipeline/frame/frame.hpp"
#include "scene/load.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::starved_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kFrame = " render " + test::kTiny + kSmallSteps;

class Starved : public ::testing::Test {
 protected:
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
    EXPECT_THAT(outcome.err, Not(HasSubstr("terminate")));
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
  expect_reported_at_some("enqueue", 301, "-2", "CL_DEVICE_NOT_AVAILABLE");
}

TEST_F(Starved, OfItsDeviceAtTheStart) {
  expect_reported("context", 2, "-2", "CL_DEVICE_NOT_AVAILABLE");
}

TEST_F(Starved, OfACompiler) {
  const fs::path image = folder_ / "a.exr";
  const auto render = [&](const std::string& builds) {
    return run("CLPV_SHIM=clBuildProgram:" + builds +
               ":-11 CLPV_SHIM_REPORT= LD_PRELOAD=" CLPV_OPENCL_SHIM
               " CLPV_PROGRAM_CACHE=off timeout 600 " CLPV_PROGRAM +
               kFrame + "-o " + image.string());
  };
  const Outcome always = render("*");
  EXPECT_EQ(always.exit_code, 1);
  EXPECT_THAT(always.err, HasSubstr("does not build"));
  EXPECT_THAT(always.err, HasSubstr("no log"));  // for a program that its driver has not seen
  EXPECT_FALSE(fs::exists(image));
  const Outcome once = render("3");  // and is tried again
  EXPECT_EQ(once.exit_code, 0) << once.err;
  EXPECT_TRUE(fs::exists(image));
}

/// A command under `ulimit`, without descriptor 3 that it may inherit; then its folder's files on
/// stderr.
class Limited : public Starved {
 protected:
  Outcome limited(const std::string& limit, const std::string& command) {
    const std::string folder = folder_.path().string();
    return run("exec 3<&-; ulimit -c 0; " + limit + " && timeout 600 env " + usual_kernels() +
               "CLPV_PROGRAM_CACHE= XDG_CACHE_HOME=" + compiled().string() + " " CLPV_PROGRAM +
               command + "-o " + folder + "/a.exr; code=$?; ls -A " + folder + " >&2; exit $code");
  }
};

// SIGXFSZ once ended the program without a word.
TEST_F(Limited, FileSizes) {
  folder_.write("a.exr", "old");
  const Outcome outcome =
      limited("ulimit -f 16", " pathtrace " + test::kTiny + " --width 120 --height 90 --spp 1 ");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("a.exr: cannot be written: File too large"));
  EXPECT_THAT(outcome.err, Not(HasSubstr(".part")));
  EXPECT_EQ(read_file(folder_ / "a.exr"), "old");
}

/// The driver's cache on a full or read-only disk, where one may be mounted.
TEST_F(Starved, OfASmallDiskForTheDriversCache) {
  const TemporaryFolder mounted;
  const std::string disk = mounted.path().string();
  const auto render = [&](const std::string& kind) {
    const std::string mount = "mount -t tmpfs -o " + kind + " none " + disk;
    return run("unshare -rm sh -c '" + mount + " && POCL_CACHE_DIR=" + disk +
               "/pocl CLPV_PROGRAM_CACHE=off " + CLPV_PROGRAM + kFrame + "-o " +
               (folder_ / "a.exr").string() + "'");
  };
  if (run("unshare -rm mount -t tmpfs none " + disk).exit_code != 0)
    GTEST_SKIP() << "no tmpfs may be mounted here";
  const Outcome full = render("size=64k"), read_only = render("ro");
  EXPECT_EQ(full.exit_code, 1) << full.err;
  EXPECT_THAT(full.err, HasSubstr("the disk of the driver's cache is full; POCL_CACHE_DIR"));
  EXPECT_EQ(read_only.exit_code, 4) << read_only.err;
  EXPECT_THAT(read_only.err, HasSubstr("cannot write its cache"));
}

// Many frames of changing options in one process: memory stays flat.

constexpr double kFlat = 1.01;  // over frames()

/// CLPV_SOAK_FRAMES sets another number.
int frames() {
  const char* wish = std::getenv("CLPV_SOAK_FRAMES");
  return wish != nullptr ? std::atoi(wish) : 20;
}

/// Resident memory of the process [bytes].
double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

/// Frames of other tests' programs.
RenderOptions small(TransportKind transport) {
  RenderOptions options = test::small_sweep();
  options.width = 24, options.height = 18;
  options.cascades = 2, options.cascade_size = 5;
  options.rsm_size = 16, options.shadow_size = 16;
  if (transport == TransportKind::sampled) {
    options.transport = transport, options.grid = 5;
    options.gather = Gathering::all, options.blockers = Blockers::seen;
  }
  return options;
}

TEST(Soak, MemoryStaysFlatOverFramesOfChangingOptions) {
  const std::vector<RenderOptions> all = {small(TransportKind::sweep),
                                          small(TransportKind::sampled)};
  const SceneData scene = load_scene(test::kTiny);
  Session session(choose_device());
  const auto render = [&](int i) {
    Frame frame(session, scene, all[static_cast<std::size_t>(i) % all.size()]);
    frame.render(scene.camera({}));
    frame.read(Show::full);
  };
  const auto render_some = [&] {
    for (int i = 0; i < frames(); ++i) render(i);
  };
  // Programs stay built, and allocators need a few rounds to level out; a leak never does.
  render_some();
  constexpr int kMaxRounds = 6;
  std::vector<double> resident{resident_bytes()};
  const std::size_t device_before = session.device_bytes(),
                    most_before = session.peak_device_bytes();
  do {
    render_some();
    resident.push_back(resident_bytes());
  } while (resident.back() > kFlat * resident.end()[-2] && resident.size() <= kMaxRounds);
  EXPECT_LE(resident.back(), kFlat * resident.end()[-2]) << testing::PrintToString(resident);
  EXPECT_EQ(session.device_bytes(), device_before);
  EXPECT_EQ(session.peak_device_bytes(), most_before);
}

}  // namespace
}  // namespace clpv::test::starved_test
