// SPDX-License-Identifier: MIT
// clpv under mpirun: two and three ranks write the same bytes as one process; a rank that fails
// ends the job, and the same command resumes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::test::mpi_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kSmall =
    " --basis sh2 --gather all --blockers seen --grid 5 --cascades 1 --rsm-size 16 --shadow-size "
    "16 ";

struct Mpi : ::testing::Test {
  void SetUp() override {
    if (std::string(CLPV_MPIEXEC).empty())
      GTEST_SKIP() << "clpv is built without MPI (Debian: apt install libopenmpi-dev)";
    if (run(CLPV_MPIEXEC " --version | grep -qE 'Open MPI|OpenRTE'").exit_code != 0)
      GTEST_SKIP() << CLPV_MPIEXEC " is not that of Open MPI (Debian: apt install openmpi-bin)";
    write_moving_scene(folder);
  }

  static std::string mpirun() {
    return CLPV_MPIEXEC " --allow-run-as-root --oversubscribe --bind-to none ";
  }
  std::string here() const { return "cd " + folder.path().string() + " && "; }
  Outcome plain(const std::string& arguments) const {
    return run(here() + CLPV_PROGRAM " " + arguments);
  }
  Outcome by(int ranks, const std::string& arguments) const {
    return run(here() + mpirun() + fmt::format("-n {} " CLPV_PROGRAM " ", ranks) + arguments);
  }
  /// Two ranks, the second started by a shell line that may do something besides.
  std::string second_as(const std::string& line, const std::string& arguments) const {
    const fs::path script =
        folder.write("second", "#!/bin/sh\n" + line + " " CLPV_PROGRAM " \"$@\"\n");
    fs::permissions(script, fs::perms::owner_all);
    return here() + mpirun() + "-n 1 " CLPV_PROGRAM " " + arguments + " : -n 1 " + script.string() +
           " " + arguments;
  }
  std::string bytes(const std::string& file) const { return read_file(folder / file); }

  static std::string film(const std::string& to, int frames) {
    return fmt::format(
               "sequence moving.json -o {} --frames {} --fps 24 --width 96 --height 72 --transport "
               "sampled",
               to, frames) +
           kSmall;
  }
  static std::string frame(const std::string& of, int i) {
    return fmt::format("{}/frame-{:04}.exr", of, i);
  }
  int there(const std::string& of, int frames) const {
    int count = 0;
    for (int i = 0; i < frames; ++i) count += fs::exists(folder / frame(of, i));
    return count;
  }
  void expect_film(const std::string& of, int frames) const {
    for (int i = 0; i < frames; ++i)
      EXPECT_TRUE(bytes(frame(of, i)) == bytes(frame("plain", i))) << of << " frame " << i;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / of), {}), frames + 1)
        << "the frames and times.jsonl";
  }

  TemporaryFolder folder;
};

using LongMpi = Mpi;

/// A quality run's JSON without times and paths of cached files.
json without_times(const std::string& text) {
  json run = json::parse(text);
  for (json& truth : run["ground_truths"]) truth.erase("file");
  for (json& cell : run["cells"])
    for (const char* key : {"times", "compute_units", "setup_s", "measured_s", "cached"})
      cell.erase(key);
  for (json& variant : run["variants"])
    for (const char* key : {"frame_ms", "stage_ms"}) variant.erase(key);
  return run;
}

TEST_F(LongMpi, QualityEqualsASingleProcess) {
  const std::string matrix =
      "quality moving.json --transport sampled --vary iterations=1,2,3,4 --width 24 --height 18 "
      "--spp 16 --frames 1 --format json" +
      kSmall;
  const Outcome alone = plain(matrix + "--cache plain");
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  const Outcome many = by(2, matrix + "--cache of2");
  ASSERT_EQ(many.exit_code, 0) << many.err;
  EXPECT_THAT(many.err, HasSubstr(" of 2: ")) << "which device rank 0 has";
  EXPECT_EQ(without_times(many.out), without_times(alone.out));
  for (const auto& entry : fs::directory_iterator(folder / "plain/references"))
    EXPECT_TRUE(read_file(entry.path()) ==
                bytes("of2/references/" + entry.path().filename().string()));
  // Each reads its own times: those of two ranks are of half of the processors.
  json again = json::parse(by(2, matrix + "--cache of2").out);
  for (json& cell : again["cells"]) EXPECT_EQ(std::exchange(cell["cached"], false), true);
  EXPECT_EQ(again, json::parse(many.out));
  EXPECT_EQ(without_times(plain(matrix + "--cache of2").out), without_times(alone.out));
}

TEST_F(LongMpi, HostsMayHaveCachesOfTheirOwn) {
  const std::string two = second_as(
      "mkdir -p elsewhere; cd elsewhere; exec",
      "quality " + (folder / "moving.json").string() +
          " --transport sampled --width 24 --height 18 --spp 4 --frames 1 --cache cache" + kSmall);
  for (int i = 0; i < 2; ++i) {
    const Outcome outcome = run(two);
    EXPECT_EQ(outcome.exit_code, 0) << i << outcome.err;
  }
  EXPECT_FALSE(fs::exists(folder / "elsewhere/cache/references")) << "root has it, and sends it";
}

TEST_F(Mpi, SequenceEqualsASingleProcess) {
  ASSERT_EQ(plain(film("plain", 7)).exit_code, 0);
  const Outcome many = by(3, film("of3", 7));
  ASSERT_EQ(many.exit_code, 0) << many.err;
  expect_film("of3", 7);
  const std::string times = bytes("of3/times.jsonl");
  const json last = json::parse(times.substr(times.rfind('\n', times.size() - 2) + 1));
  EXPECT_EQ(last["summary"]["frames"], 7) << "of all ranks";
}

TEST_F(Mpi, PathtraceEqualsASingleProcess) {
  const std::string truth =
      "pathtrace moving.json --width 40 --height 30 --bounces all --view indirect,direct --noise "
      "0.2";
  ASSERT_EQ(plain(truth + " -o plain.exr --stats plain.json").exit_code, 0);
  const Outcome many = by(3, truth + " -o many.exr --stats many.json");
  ASSERT_EQ(many.exit_code, 0) << many.err;
  EXPECT_TRUE(bytes("many.exr") == bytes("plain.exr"));
  EXPECT_EQ(json::parse(bytes("many.json"))["rays"], json::parse(bytes("plain.json"))["rays"]);
}

TEST_F(Mpi, AFailingRankReportsAndEndsTheJob) {
  constexpr int kEndless = 20000, kFrames = 6;
  const Outcome outcome = run(second_as(
      "CLPV_SHIM=memory:5:-4 LD_PRELOAD=" CLPV_OPENCL_SHIM " exec", film("failed", kEndless)));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("clpv: rank 1 on "), HasSubstr("CL_MEM_OBJECT_ALLOCATION_FAILURE")));
  EXPECT_LT(there("failed", kEndless), kEndless) << "it went on";
  ASSERT_EQ(plain(film("plain", kFrames)).exit_code, 0);
  ASSERT_EQ(plain(film("failed", kFrames)).exit_code, 0);
  for (int i = 0; i < kFrames; ++i)
    EXPECT_TRUE(bytes(frame("failed", i)) == bytes(frame("plain", i))) << i;
}

TEST_F(Mpi, ExitCodesComeThrough) {
  const Outcome absent = by(2, "pathtrace absent.json -o a.exr");
  EXPECT_EQ(absent.exit_code, 3);
  EXPECT_THAT(absent.err, AllOf(HasSubstr("clpv: rank "), HasSubstr(": absent.json")));
  const Outcome usage = by(2, "pathtrace moving.json");
  EXPECT_EQ(usage.exit_code, 2);
  EXPECT_THAT(usage.err, HasSubstr("--output is required"));
  const Outcome other = by(2, "render moving.json -o a.exr");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, AllOf(HasSubstr("render: not for several processes (found: rank "),
                               HasSubstr(" of 2)")));
  EXPECT_FALSE(fs::exists(folder / "a.exr"));
}

}  // namespace
}  // namespace clpv::test::mpi_test
