// SPDX-License-Identifier: MIT
// Promises of docs/security.md: caches trust only what this user wrote and never end a run; outputs
// spare inputs; images tell nothing about the machine; clpv opens no connections.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "device/driver_cache.hpp"
#include "device/program_cache.hpp"
#include "image/image.hpp"
#include "image/image_io.hpp"
#include "quality/quality.hpp"
#include "scene/load.hpp"
#include "support/cache_folder.hpp"
#include "support/log.hpp"
#include "support/scratch_folder.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::trust_test {
namespace {

namespace fs = std::filesystem;
using test::kSmallSteps;
using test::kTiny;
using test::read_file;
using test::run_here;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// ---------------------------------------------------------------------------------------------------
// caches

/// Mode bits of a file.
mode_t mode_of(const fs::path& path) {
  struct stat found {};
  EXPECT_EQ(::lstat(path.c_str(), &found), 0) << path;
  return found.st_mode & 07777;
}

struct CacheTest : ::testing::Test {
  test::TemporaryFolder folder;
  const CacheFolder cache{folder / "made/on demand"};
  const fs::path entry = cache.path() / "entry", other = folder / "other";

  void SetUp() override { folder.write("other", "of others"); }
};

TEST_F(CacheTest, FoldersAreForTheirOwnerOnly) {
  const mode_t before = ::umask(002);
  EXPECT_EQ(cache.write("entry", std::string_view("text")), "");
  ::umask(before);
  EXPECT_EQ(mode_of(cache.path()), 0700u);
  EXPECT_EQ(mode_of(cache.path().parent_path()), 0700u);
  EXPECT_EQ(cache.read("entry"), "text");
  EXPECT_EQ(cache.read("entry", 3), std::nullopt) << "longer than allowed";
  EXPECT_EQ(cache.read("absent"), std::nullopt);
}

TEST_F(CacheTest, LinksAndFifosAreNeitherReadNorWrittenThrough) {
  ASSERT_EQ(cache.problem(), "");
  const std::function<void()> plant[] = {[&] { fs::create_symlink(other, entry); },
                                         [&] { fs::create_symlink(folder / "missing", entry); },
                                         [&] { ASSERT_EQ(::mkfifo(entry.c_str(), 0666), 0); }};
  for (const auto& make : plant) {
    fs::remove(entry);
    make();
    EXPECT_EQ(cache.read("entry"), std::nullopt);
    EXPECT_EQ(cache.write("entry", std::string_view("mine")), "");
    EXPECT_EQ(cache.read("entry"), "mine");
    EXPECT_EQ(read_file(other), "of others");
    EXPECT_FALSE(fs::exists(folder / "missing"));
  }
  fs::remove(entry);
  fs::create_directory(entry);
  EXPECT_EQ(cache.read("entry"), std::nullopt);
  EXPECT_THAT(cache.write("entry", std::string_view("mine")), HasSubstr("cannot be written"));
}

TEST_F(CacheTest, WhatOthersMayHaveWrittenIsNotUsed) {
  ASSERT_EQ(cache.write("entry", std::string_view("mine")), "");
  for (const mode_t mode : {0770u, 0707u, 0777u, 01777u}) {
    ::chmod(cache.path().c_str(), mode);
    EXPECT_EQ(cache.read("entry"), std::nullopt);
    EXPECT_THAT(cache.write("second", std::string_view("x")), HasSubstr("chmod go-w"));
    EXPECT_FALSE(fs::exists(cache.path() / "second"));
  }
  ::chmod(cache.path().c_str(), 0755);
  EXPECT_EQ(cache.read("entry"), "mine");
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give files away";
  ASSERT_EQ(::lchown(entry.c_str(), 65534, 65534), 0);
  EXPECT_EQ(cache.read("entry"), std::nullopt) << "an entry of another user";
  EXPECT_EQ(cache.write("entry", std::string_view("mine")), "");
  EXPECT_EQ(cache.read("entry"), "mine");
  ASSERT_EQ(::lchown(cache.path().c_str(), 65534, 65534), 0);
  EXPECT_EQ(cache.read("entry"), std::nullopt) << "a folder of another user";
  EXPECT_THAT(cache.write("entry", std::string_view("x")), HasSubstr("another user"));
}

TEST_F(CacheTest, AFolderThatCannotBeMadeIsAReason) {
  EXPECT_THAT(CacheFolder(other / "below").write("entry", std::string_view("x")),
              HasSubstr("Not a directory"));
  EXPECT_EQ(CacheFolder(other / "below").read("entry"), std::nullopt);
}

TEST_F(CacheTest, ProgramsAndMarksAreEntries) {
  const ProgramCache programs(cache.path());
  const ProgramCache::Binary binary(10, 7);
  ASSERT_TRUE(programs.store("key", binary));
  fs::rename(programs.file_of("key"), folder / "moved");
  fs::create_symlink(folder / "moved", programs.file_of("key"));
  EXPECT_FALSE(programs.load("key"));
  EXPECT_TRUE(programs.store("key", {1}));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(programs.file_of("key"))));

  ::setenv("POCL_CACHE_DIR", (folder / "pocl").c_str(), 1);
  Device device;
  device.platform = "Portable Computing Language";
  const CompiledMarks marks(device);
  ::unsetenv("POCL_CACHE_DIR");
  EXPECT_FALSE(marks.has("key"));
  marks.add("key");
  EXPECT_TRUE(marks.has("key"));
  const fs::path mark = *fs::directory_iterator(folder / "pocl/clpv");
  fs::remove(mark);
  fs::create_symlink(other, mark);
  EXPECT_FALSE(marks.has("key"));
  marks.add("key");
  EXPECT_TRUE(marks.has("key"));
  EXPECT_EQ(read_file(other), "of others");
}

TEST_F(CacheTest, ADamagedCellIsMeasuredAgain) {
  set_log_level(true, 0);
  QualityStore store(cache.path());
  QualityCell cell;
  cell.scene = "room", cell.nrmse = 0.25;
  cell.stage_ms["gather"] = 1.5;
  store.keep("k", cell);
  ASSERT_TRUE(store.find("k"));
  const std::string whole = read_file(cache.path() / "k.json");
  for (std::size_t i = 0; i + 1 < whole.size(); ++i) {  // the last byte is the end of the line
    std::string flipped = whole;
    flipped[i] ^= 1;
    for (const std::string& damaged : {flipped, whole.substr(0, i)}) {
      fs::remove(cache.path() / "k.json");
      CacheFolder(cache.path()).write("k.json", damaged);
      const auto found = store.find("k");
      EXPECT_TRUE(!found || to_json(*found) == to_json(cell)) << damaged;
    }
  }
}

TEST_F(CacheTest, ADamagedTruthIsTracedAgain) {
  set_log_level(true, 0);
  const SceneData scene = load_scene(kTiny);
  const auto traced = [&] {
    return cached_ground_truth(cache.path(), scene, scene.cameras[0], 8, 6, {.samples = 1});
  };
  const GroundTruth first = traced();
  ASSERT_TRUE(first.traced);
  ASSERT_FALSE(traced().traced);
  const std::string whole = read_file(first.file);
  for (std::size_t i = 0; i < whole.size(); i += 97) {
    std::string flipped = whole;
    flipped[i] ^= 0x10;
    for (const std::string& damaged : {flipped, whole.substr(0, i)}) {
      CacheFolder(cache.path()).write(first.file.filename(), damaged);
      const GroundTruth again = traced();
      EXPECT_TRUE(extract_layer(again.image, "indirect", "again").pixels ==
                  extract_layer(first.image, "indirect", "first").pixels)
          << i;
    }
  }
  EXPECT_EQ(read_file(first.file), whole) << "and replaced";
}

/// `clpv quality` of one cell.
std::string quality(const fs::path& cache) {
  return " quality " + kTiny + kSmallSteps + "--spp 1 --frames 1 --format json --cache " +
         cache.string();
}

TEST_F(CacheTest, AFifoInPlaceOfACellOrTruthDoesNotEndQuality) {
  const fs::path kept = folder / "kept";
  ASSERT_EQ(run_here(quality(kept)).exit_code, 0);
  for (const char* below : {"cells", "references"}) {
    const fs::path file = *fs::directory_iterator(kept / below);
    fs::remove(file);
    ASSERT_EQ(::mkfifo(file.c_str(), 0666), 0);
    const test::Outcome outcome = run_here(quality(kept));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("tiny"));
    EXPECT_TRUE(fs::is_regular_file(file)) << below;
  }
}

/// Disks of 4 and 16 kB as --cache, where one may be mounted.
TEST_F(CacheTest, AFullDiskDoesNotEndQuality) {
  const std::string disk = folder.path().string();
  if (test::run("unshare -rm mount -t tmpfs none " + disk).exit_code != 0)
    GTEST_SKIP() << "no tmpfs may be mounted here";
  for (const char* size : {"4k", "16k"}) {
    const test::Outcome outcome = test::run(
        "unshare -rm sh -c 'mount -t tmpfs -o size=" + std::string(size) + " none " + disk +
        " && " CLPV_PROGRAM + quality(folder.path()) + " --vary gather-offset=0,1,2,3,4'");
    EXPECT_EQ(outcome.exit_code, 0) << size << outcome.err;
    EXPECT_EQ(nlohmann::json::parse(outcome.out).at("cells").size(), 5u) << size << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr("not cached")) << size;
  }
}

TEST_F(CacheTest, TwoProcessesShareOneQualityCacheAndOutput) {
  const std::string command = CLPV_PROGRAM + quality(folder / "kept") +
                              " --vary gather-offset=0,1 -o " + (folder / "a.json").string();
  const test::Outcome both =
      test::run("( " + command + " ) & " + command + "; code=$?; wait $! && exit $code");
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.err, Not(HasSubstr("again")));
  EXPECT_EQ(nlohmann::json::parse(read_file(folder / "a.json")).at("cells").size(), 2u);
  const test::Outcome third = run_here(quality(folder / "kept") + " --vary gather-offset=0,1");
  EXPECT_THAT(third.err, Not(HasSubstr("again")));
}

// -------------------------------------------------------------------------------------- temporary
// folders

TEST(ScratchFolders, OfKilledRunsAreRemovedByTheNext) {
  const test::TemporaryFolder folder;
  ::setenv("TMPDIR", folder.path().c_str(), 1);
  folder.write("clpv-aaaaaa/below/file", "of a killed run");
  folder.write("clpv-bbbbbb/file", "of a run that goes on");
  folder.write("clpv-cccccc/file", "just made");
  folder.write("clpv-data/file", "of the user");
  const auto hours_ago = fs::file_time_type::clock::now() - std::chrono::hours(2);
  for (const char* old : {"clpv-aaaaaa", "clpv-bbbbbb", "clpv-data"})
    fs::last_write_time(folder / old, hours_ago);
  const int running = ::open((folder / "clpv-bbbbbb").c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(running, LOCK_EX), 0);
  fs::path made;
  {
    const ScratchFolder scratch;
    made = scratch.path();
    EXPECT_EQ(mode_of(made), 0700u);
  }
  ::unsetenv("TMPDIR");
  ::close(running);
  EXPECT_FALSE(fs::exists(made));
  EXPECT_FALSE(fs::exists(folder / "clpv-aaaaaa"));
  for (const char* kept : {"clpv-bbbbbb", "clpv-cccccc", "clpv-data"})
    EXPECT_TRUE(fs::exists(folder / kept)) << kept;
}

TEST(ScratchFolders, AKilledProcessLosesItsLock) {
  const test::TemporaryFolder folder;
  ::setenv("TMPDIR", folder.path().c_str(), 1);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const ScratchFolder scratch;
    ::raise(SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  const fs::path left = *fs::directory_iterator(folder.path());
  fs::last_write_time(left, fs::file_time_type::clock::now() - std::chrono::hours(2));
  { const ScratchFolder scratch; }
  ::unsetenv("TMPDIR");
  EXPECT_FALSE(fs::exists(left));
}

TEST(ScratchFolders, AMissingTmpdirIsNamed) {
  const test::TemporaryFolder folder;
  const test::Outcome drawing = test::run(
      "TMPDIR=/nonexistent " CLPV_PROGRAM " basis sh2 --figures " + (folder / "out").string());
  // The usual kernels, of which nothing knows that they are compiled.
  fs::create_directory(folder / "pocl");
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(test::usual_kernels_folder(), none))
    if (entry.path().filename() != "clpv")
      fs::create_symlink(entry.path(), folder / "pocl" / entry.path().filename());
  const test::Outcome cold =
      test::run("TMPDIR=/nonexistent POCL_CACHE_DIR=" + (folder / "pocl").string() +
                " XDG_CACHE_HOME=" + folder.path().string() + " " CLPV_PROGRAM " render " + kTiny +
                kSmallSteps + "-o " + (folder / "a.exr").string());
  EXPECT_EQ(drawing.exit_code, 1);
  EXPECT_THAT(drawing.err, HasSubstr("TMPDIR: found '/nonexistent'"));
  EXPECT_EQ(cold.exit_code, 0) << "a frame that is compiled needs no such folder either\n"
                               << cold.err;
  const bool helped = std::thread::hardware_concurrency() > 1;
  EXPECT_THAT(cold.err, HasSubstr(helped ? "TMPDIR: found '/nonexistent'" : ""));
}

/// What choose_driver_cache() sets with these variables; its message in `err`.
fs::path chosen_cache(const fs::path& home, const std::string& cache, std::string& err) {
  ::unsetenv("POCL_CACHE_DIR");
  home.empty() ? ::unsetenv("HOME") : ::setenv("HOME", home.c_str(), 1);
  cache.empty() ? ::unsetenv("XDG_CACHE_HOME") : ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  set_log_level(false, 0);
  ::testing::internal::CaptureStderr();
  choose_driver_cache();
  err = ::testing::internal::GetCapturedStderr();
  return driver_cache_folder().value_or("");
}

// Without HOME, PoCL loads code from /tmp/pocl, whoever made it.
TEST(DriverCache, IsAFolderThatNobodyElseCanWrite) {
  const test::TemporaryFolder folder;
  const std::map<std::string, std::string> before = [] {
    std::map<std::string, std::string> values;
    for (const char* name : {"POCL_CACHE_DIR", "HOME", "XDG_CACHE_HOME"})
      if (const char* value = std::getenv(name)) values[name] = value;
    return values;
  }();
  std::string err;
  EXPECT_EQ(chosen_cache("/none", folder.path(), err), folder / "clpv/pocl");
  EXPECT_EQ(mode_of(folder / "clpv/pocl"), 0700u);
  EXPECT_EQ(chosen_cache(folder.path(), "relative", err), folder / ".cache/clpv/pocl");
  EXPECT_EQ(err, "");
  const fs::path scratch = chosen_cache("", "", err);
  EXPECT_EQ(mode_of(scratch), 0700u);
  EXPECT_THAT(err, AllOf(HasSubstr("absolute path"), HasSubstr("compiles its kernels again")));
  EXPECT_EQ(chosen_cache("relative", "relative", err), scratch);
  ::chmod((folder / "clpv/pocl").c_str(), 0777);
  EXPECT_EQ(chosen_cache("", folder.path(), err), scratch);
  EXPECT_THAT(err, HasSubstr("others can write it"));
  if (::geteuid() == 0) {
    ::chmod((folder / "clpv/pocl").c_str(), 0700);
    ASSERT_EQ(::chown((folder / "clpv/pocl").c_str(), 65534, 65534), 0);
    EXPECT_EQ(chosen_cache("", folder.path(), err), scratch);
    EXPECT_THAT(err, HasSubstr("another user"));
  }
  for (const char* name : {"POCL_CACHE_DIR", "HOME", "XDG_CACHE_HOME"}) {
    const auto value = before.find(name);
    value == before.end() ? ::unsetenv(name) : ::setenv(name, value->second.c_str(), 1);
  }
}

// --------------------------------------------------------------------------------------------------
// outputs

TEST(Outputs, SpareInputsAndEachOther) {
  const test::TemporaryFolder folder;
  for (const auto& entry : fs::directory_iterator(fs::path(kTiny).parent_path()))
    if (entry.path().stem() == "tiny") fs::copy(entry.path(), folder.path());
  folder.write("my.json", R"({"model": "tiny.gltf"})");
  folder.write("times.json", R"({"model": "tiny.gltf"})");
  folder.write("points.csv", "0,0,0,0,1,0\n");
  const std::string scene = " my.json" + kSmallSteps;
  for (const std::string& command :
       {"render" + scene + "-o o.exr --stats o.exr", "render" + scene + "-o o.exr --stats my.json",
        "render" + scene + "-o o.exr --dump-normals ./o.exr",
        "render" + scene + "-o o.exr --stats tiny.gltf",  // not named on the command line
        std::string("pathtrace my.json -o o.exr --stats my.json"),
        "query" + scene + "--points points.csv -o points.csv",
        "quality" + scene + "--cache cache -o my.json",
        std::string("bench regression --scene my.json -o my.json"),
        "sequence times.json" + kSmallSteps + "--frames 1 --fps 1 -o ."}) {
    const test::Outcome outcome = run_here(command, folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << command << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("allowed: another file")) << command;
    EXPECT_EQ(read_file(folder / "my.json"), R"({"model": "tiny.gltf"})");
    EXPECT_FALSE(fs::exists(folder / "o.exr")) << command;
  }
  fs::copy(folder / "my.json", folder / "again.json");
  EXPECT_EQ(run_here("render again.json" + kSmallSteps + "-o o.exr --stats s.json", folder.path())
                .exit_code,
            0);
  EXPECT_EQ(run_here("compare o.exr o.exr -o o.exr", folder.path()).exit_code, 2);
}

TEST(Outputs, DevicesAndFifosAreRejectedBeforeTheWork) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "fifo.exr").c_str(), 0666), 0);
  fs::create_symlink("/dev/full", folder / "full.exr");
  for (const char* name : {"fifo.exr", "full.exr"}) {
    const test::Outcome outcome =
        run_here("render " + kTiny + kSmallSteps + "-o " + name, folder.path());
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.err,
                HasSubstr(std::string(name) + ": cannot be written: it is not a regular file"));
  }
}

// Paths of scene and model, as given, were once in each image.
TEST(Outputs, MetadataHoldsNoFolderUserOrHost) {
  const test::TemporaryFolder folder;
  folder.write("secret/my.json", "{\"model\": \"" + kTiny + "\"}");
  const std::string scene = (folder / "secret/my.json").string();
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  for (const std::string& command :
       {"render " + scene + " --model " + kTiny + kSmallSteps + "-o a.exr",
        "render " + scene + " --model " + kTiny + kSmallSteps + "-o a.png",
        "pathtrace " + scene + " --model " + kTiny + " --width 8 --height 6 --spp 1 -o a.exr"}) {
    const test::Outcome outcome = run_here(command, folder.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string file = command.substr(command.rfind(' ') + 1),
                      bytes = read_file(folder / file);
    EXPECT_EQ(read_metadata(folder / file).at("scene"), "my.json");
    EXPECT_EQ(read_metadata(folder / file).at("model"), "tiny.gltf");
    for (const std::string& told :
         {folder.path().string(), std::string(CLPV_SOURCE_DIR), std::string(host)})
      EXPECT_EQ(bytes.find(told), std::string::npos) << told << " in " << file;
  }
}

// -------------------------------------------------------------------------------------------------
// network

TEST(Network, ClpvOpensNoConnections) {
  std::vector<std::string> openers;
  for (const auto& entry : fs::recursive_directory_iterator(CLPV_SOURCE_DIR "/host"))
    if (entry.is_regular_file() && read_file(entry.path()).find("socket(") != std::string::npos)
      openers.push_back(entry.path().filename().string());
  EXPECT_THAT(openers, ::testing::IsEmpty());
}

}  // namespace
}  // namespace clpv::trust_test
