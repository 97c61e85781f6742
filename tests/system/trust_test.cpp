// SPDX-License-Identifier: MIT
// Promises of docs/security.md: caches trust only what this user wrote and never end a run; outputs
// spare inputs; images tell nothing about the machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "device/driver_cache.hpp"
#include "device/program_cache.hpp"
#include "image/image.hpp"
#include "image/image_io.hpp"
#include "quality/quality.hpp"
#include "scene/load.hpp"
#include "support/cache_folder.hpp"
#include "support/log.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::trust_test {
namespace fs = std::filesystem;
using nlohmann::json;
using test::kSmallSteps;
using test::kTiny;
using test::mode_of;
using test::must_run_here;
using test::read_file;
using test::run_here;
using ::testing::HasSubstr;

// ---------------------------------------------------------------------------------------------------
// caches

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

TEST_F(CacheTest, AnyDamageOfACheckedEntryIsFound) {
  const std::string bytes("a\0b", 3);
  ASSERT_EQ(cache.write_checked("entry", bytes), "");
  EXPECT_EQ(cache.read_checked("entry"), bytes);
  const std::string whole = read_file(entry);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string flipped = whole;
    flipped[i] ^= 0x10;
    for (const std::string& damaged : {flipped, whole.substr(0, i)}) {
      cache.write("entry", damaged);
      EXPECT_EQ(cache.read_checked("entry"), std::nullopt) << i;
    }
  }
}

TEST_F(CacheTest, ADamagedTruthIsTracedAgain) {
  log_to_stderr(LogLevel::error);
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

// -------------------------------------------------------------------------------------- temporary
// folders

/// Paths below a folder and the contents of its files.
std::map<std::string, std::string> contents_of(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    all[entry.path().string()] = entry.is_regular_file() ? read_file(entry.path()) : "";
  return all;
}

/// A folder as TMPDIR.
struct ScratchFolders : ::testing::Test {
  test::TemporaryFolder folder;
  const test::Variable variable{"TMPDIR", folder.path().string()};
};

TEST_F(ScratchFolders, AreForThisUserAloneAndDisappear) {
  folder.write("clpv-output/a", "of the user");
  const auto before = contents_of(folder.path());
  {
    const ScratchFolder scratch;
    EXPECT_EQ(scratch.path().parent_path(), folder.path());
    EXPECT_EQ(mode_of(scratch.path()), 0700u);
  }
  EXPECT_EQ(contents_of(folder.path()), before);
}

/// Cache folder that choose_driver_cache() sets with these variables; its message in `err`.
fs::path chosen_cache(const fs::path& home, const std::string& cache, std::string& err) {
  ::unsetenv("POCL_CACHE_DIR");
  home.empty() ? ::unsetenv("HOME") : ::setenv("HOME", home.c_str(), 1);
  cache.empty() ? ::unsetenv("XDG_CACHE_HOME") : ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  log_to_stderr(LogLevel::info);
  ::testing::internal::CaptureStderr();
  choose_driver_cache();
  err = ::testing::internal::GetCapturedStderr();
  return driver_cache_folder().value_or("");
}

// Without HOME, PoCL loads code from /tmp/pocl, whoever made it.
TEST(DriverCache, IsAFolderThatNobodyElseCanWrite) {
  const test::TemporaryFolder folder;
  const test::Variable pocl("POCL_CACHE_DIR"), home("HOME"), cache("XDG_CACHE_HOME");
  std::string err;
  EXPECT_EQ(chosen_cache("/none", folder.path(), err), folder / "clpv/pocl");
  EXPECT_EQ(mode_of(folder / "clpv/pocl"), 0700u);
  EXPECT_EQ(chosen_cache(folder.path(), "relative", err), folder / ".cache/clpv/pocl");
  EXPECT_EQ(err, "");
  const fs::path scratch = chosen_cache("", "", err);
  EXPECT_EQ(mode_of(scratch), 0700u);
  EXPECT_THAT(err,
              testing::AllOf(HasSubstr("absolute path"), HasSubstr("compiles its kernels again")));
  EXPECT_EQ(chosen_cache("relative", "relative", err), scratch);
  ::chmod((folder / "clpv/pocl").c_str(), 0777);
  EXPECT_EQ(chosen_cache("", folder.path(), err), scratch);
  EXPECT_THAT(err, HasSubstr("others can write it"));
}

// --------------------------------------------------------------------------------------------------
// outputs

/// A folder with a scene, its model and sky, points and centres.
struct Inputs : ::testing::Test {
  test::TemporaryFolder folder;

  void SetUp() override {
    test::GltfBuilder model;
    model.square(2);
    model.write(folder);
    write_exr(folder / "my sky.exr", make_image(2, 1, {"R", "G", "B"}));
    folder.write("my.json", R"({"model": "model.gltf", "sky": {"map": "my%20sky.exr"}})");
    for (const char* name : {"centres.json", "stability.json"})
      folder.write(name, R"({"centres": [[1,0,0],[-1,0,0],[0,1,0],[0,-1,0],[0,0,1],[0,0,-1]]})");
    folder.write("points.csv", "0,0,0,0,1,0\n");
    folder.write("index.html", R"({"variants": []})");
    folder.write("gather/gather.cl", "a kernel file");
  }
};

TEST_F(Inputs, AreReplacedByNoOutput) {
  const test::TemporaryFolder cache;
  const auto before = contents_of(folder.path());
  // A scene with a sky is swept.
  const std::string scene = " my.json" + kSmallSteps.substr(0, kSmallSteps.find("--basis")),
                    cached = " --spp 1 --frames 1 --cache " + cache.path().string();
  const test::Outcome kernel = [&] {
    const test::Variable kernels("CLPV_KERNEL_DIR", folder.path().string());
    return run_here("check --list --junit gather/gather.cl", folder.path());
  }();
  EXPECT_EQ(kernel.exit_code, 2) << kernel.err;
  const std::vector<std::string> commands{
      "render" + scene + "-o o.exr --stats my.json",
      "render" + scene + "-o o.exr --stats ./o.exr",
      "render" + scene + "-o 'my sky.exr'",
      "pathtrace my.json -o o.exr --stats my.json",
      "query" + scene + "--points points.csv -o points.csv",
      "sequence" + scene + "--frames 3 --fps 1 --stability -o . --centres stability.json",
      "quality" + scene + cached + " -o my.json",
      "quality" + scene + cached + " --vary centres=stability.json,centres.json -o centres.json",
      "bench bases --scene my.json -o my.json",
      "report . --quality index.html"};
  for (const std::string& command : commands) {
    const test::Outcome outcome = run_here(command, folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << command << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("allowed: another file")) << command;
    EXPECT_TRUE(contents_of(folder.path()) == before) << command;
  }
}

TEST_F(Inputs, AreNoneWhereOutputsOfEarlierRunsAreReplaced) {
  const std::string scene = " my.json" + kSmallSteps;
  for (const char* lux : {"1", "2"}) {
    folder.write("my.json", R"({"model": "model.gltf", "lights": [{"kind": "directional",
        "direction": [0, -1, 0.1], "illuminance_lux": )" +
                                std::string(lux) + "}]}");
    for (const std::string& command : {"render" + scene + "-o o.exr --stats s.json",
                                       "sequence" + scene + "--frames 2 --fps 1 -o film"}) {
      const test::Outcome outcome = must_run_here(command, folder.path());
      EXPECT_THAT(outcome.err, testing::Not(HasSubstr("existed"))) << outcome.err;
    }
  }
  EXPECT_EQ(run_here("compare o.exr o.exr -o o.exr", folder.path()).exit_code, 2);
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
    const test::Outcome outcome = must_run_here(command, folder.path());
    const std::string file = command.substr(command.rfind(' ') + 1),
                      bytes = read_file(folder / file);
    EXPECT_EQ(read_metadata(folder / file).at("scene"), "my.json");
    EXPECT_EQ(read_metadata(folder / file).at("model"), "tiny.gltf");
    for (const std::string& told :
         {folder.path().string(), std::string(CLPV_SOURCE_DIR), std::string(host)})
      EXPECT_EQ(bytes.find(told), std::string::npos) << told << " in " << file;
  }
}

}  // namespace clpv::trust_test
