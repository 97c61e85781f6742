// SPDX-License-Identifier: MIT
// Every command in folders full of files of others: only its named outputs appear, and nothing else
// changes (docs/security.md).
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "cli/commands.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::bystanders_test {
namespace {

namespace fs = std::filesystem;
using test::kTiny;
using test::read_file;

const std::string kSmall = test::kSmallSteps;

/// What must not change of a file. Folders may get entries, and so another time.
struct State {
  mode_t mode = 0;
  uid_t owner = 0;
  ino_t file = 0;
  std::pair<time_t, long> changed{};
  std::string content;  ///< of a regular file; target of a link
  bool operator==(const State&) const = default;
};

State state_of(const fs::path& path) {
  struct stat found {};
  EXPECT_EQ(::lstat(path.c_str(), &found), 0) << path;
  State state{found.st_mode, found.st_uid, found.st_ino, {}, {}};
  if (S_ISDIR(found.st_mode)) return state;
  state.changed = {found.st_mtim.tv_sec, found.st_mtim.tv_nsec};
  if (S_ISREG(found.st_mode)) state.content = read_file(path);
  if (S_ISLNK(found.st_mode)) state.content = fs::read_symlink(path).string();
  return state;
}

using Snapshot = std::map<std::string, State>;  // by path below the folder

Snapshot snapshot_of(const fs::path& folder) {
  Snapshot all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    all[entry.path().lexically_relative(folder).string()] = state_of(entry.path());
  return all;
}

void age(const fs::path& path) {
  const timespec times[] = {{1'600'000'000, 0}, {1'600'000'000, 0}};
  ::utimensat(AT_FDCWD, path.c_str(), times, AT_SYMLINK_NOFOLLOW);
}

/// Fills a folder with files as anyone might have them, all of which are old.
void plant(const test::TemporaryFolder& root, const std::string& folder) {
  const std::string here = folder + "/";
  for (const char* name : {"clpv-output/a",
                           "clpv-abcdef/below/a",
                           "clpv-images/1.exr",
                           "clpv-master/README.md",
                           "clpv-test-abcdef/a",
                           "run-abcdef/a",
                           "claims/a.done",
                           "my.program.backup.tar",
                           "a.program",
                           "0123456789abcdef.program",
                           "0123456789abcdef.json",
                           ".a.exr.1-0.part",
                           ".a.exr.1-0.part.bak",
                           ".index.html.1",
                           "a.part",
                           "index.html.tmp",
                           "probe-1",
                           "my.json",
                           "times.json",
                           "stability.json",
                           "index.html",
                           "report.json",
                           "pocl/kcache/a",
                           "kcache/tempfile",
                           "core",
                           "out",
                           "-rf",
                           " ",
                           "with a blank",
                           ".hidden",
                           "readonly/a",
                           "sticky/a",
                           "open/a",
                           "cells/a.json",
                           "references/tiny-view-0123456789abcdef.exr"})
    root.write(here + name, std::string("of a user: ") + name);
  const fs::path path = root / folder;
  fs::create_symlink("my.json", path / "link");
  fs::create_symlink("nowhere", path / ".b.exr.1-0.part");
  fs::create_symlink("sticky", path / "clpv-lnklnk");
  ASSERT_EQ(::mkfifo((path / "fifo").c_str(), 0622), 0);
  ::chmod((path / "my.json").c_str(), 0444);
  ::chmod((path / "clpv-output/a").c_str(), 0600);
  ::chmod((path / "core").c_str(), 06755);
  ::chmod((path / "readonly").c_str(), 0555);
  ::chmod((path / "sticky").c_str(), 01777);
  ::chmod((path / "open").c_str(), 02770);
  for (const auto& entry : fs::recursive_directory_iterator(path)) age(entry.path());
}

/// A run of the program in folder `work`. An output that ends in '/' is a folder.
struct Invocation {
  std::string arguments;
  std::vector<std::string> outputs = {};  ///< all of which appear
  std::vector<std::string> perhaps = {};  ///< which may appear
};

/// Runs of each command that writes all its outputs.
const std::multimap<std::string, Invocation>& runs() {
  static const std::string tiny = " " + kTiny + kSmall;
  static const std::multimap<std::string, Invocation> all{
      {"devices", {"devices"}},
      {"render", {"render" + tiny + "-o a.exr --stats a.json", {"a.exr", "a.json"}}},
      {"render", {"render" + tiny + "-o a.png --view full,albedo", {"a.full.png", "a.albedo.png"}}},
      {"sequence",
       {"sequence" + tiny + "-o film --frames 2 --fps 1 --stability --video v.mp4",
        {"film/", "v.mp4"}}},
      {"query", {"query" + tiny + "--points points.csv -o q.csv", {"q.csv"}}},
      {"query",
       {"query " + kTiny + " --points points.csv --truth --spp 1 -o truth.csv", {"truth.csv"}}},
      {"bake",
       {"bake " + kTiny + " --from pathtrace --spp 1 --probes 2,2,2 --check 1 -o b.ktx2",
        {"b.ktx2", "b.ktx2.json"}}},
      {"check", {"check --stage sizes --junit j.xml", {"j.xml"}}},
      {"check",
       {"check --stage sizes --capsules caps --capsule 'sizes shared structs'", {"caps/"}}},
      {"compare", {"compare one.exr one.exr -o d.png", {"d.png"}}},
      {"pathtrace",
       {"pathtrace " + kTiny + " --width 12 --height 9 --spp 1 -o t.exr --stats t.json",
        {"t.exr", "t.json"}}},
      {"quality",
       {"quality" + tiny + "--spp 1 --frames 1 --cache kept -o quality.json",
        {"kept/", "quality.json"}}},
      {"quality", {"quality" + tiny + "--spp 1 --frames 1"}},
      {"basis", {"basis sh2 --figures figures", {"figures/"}}},
      {"bench",
       {"bench ceilings --repetitions 1 --filter launch --plot plots --log b.jsonl -o b.json",
        {"b.jsonl", "b.json"},
        {"plots/"}}},
      {"report",
       {"report page " + test::kTinyRoom + " --width 12 --height 9 --spp 1 --cache seen",
        {"page/", "seen/"}}},
      {"prepare", {"prepare" + tiny + "--claims shared", {}, {"shared/"}}},
  };
  return all;
}

class Bystanders : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* folder : {"work", "tmp", "home", "cache", "cache/clpv"}) plant(root_, folder);
    for (const char* folder : {"film", "page", "plots", "figures", "images", "kept", "shared"})
      root_.write(std::string("work/") + folder + "/notes.txt", "of a user");
    root_.write("work/points.csv", "0,0,0,0,1,0\n");
    // In place of ffmpeg.
    root_.write("bin/ffmpeg",
                "#!/bin/sh\ncat >/dev/null\nfor last; do :; done\n: >\"${last#file:}\"\n");
    ::chmod((root_ / "bin/ffmpeg").c_str(), 0755);
    ::chmod((root_ / "cache/clpv").c_str(), 0700);
    const test::Outcome traced =
        program("pathtrace " + kTiny + " --width 6 --height 4 --spp 1 --view indirect -o one.exr");
    ASSERT_EQ(traced.exit_code, 0) << traced.err;
    planted_ = snapshot_of(root_.path());
  }

  test::Outcome program(const std::string& arguments) const {
    const std::string root = root_.path().string();
    return test::run("cd " + root + "/work && env " + test::usual_kernels() + "TMPDIR=" + root +
                     "/tmp HOME=" + root + "/home XDG_CACHE_HOME=" + root + "/cache PATH=" + root +
                     "/bin:$PATH " CLPV_PROGRAM " " + arguments);
  }

  /// True for a path that this run may create. Below its own cache and scratch folders clpv may
  /// create what it likes.
  static bool may_appear(const std::string& path, const Invocation& run) {
    if (path.starts_with("cache/clpv/") ||
        path == "tmp/.clpv-scratch-" + std::to_string(::geteuid()))
      return true;
    std::vector<std::string> outputs = run.outputs;
    outputs.insert(outputs.end(), run.perhaps.begin(), run.perhaps.end());
    return std::ranges::any_of(outputs, [&](const std::string& output) {
      const std::string below = "work/" + output;
      return output.ends_with('/') ? (path + "/").starts_with(below) : path == below;
    });
  }

  /// Runs those commands, or all others.
  void expect_only_named_outputs(const std::set<std::string>& commands, bool those) {
    for (const auto& [command, run] : runs())
      if (commands.contains(command) == those) expect_only_named_outputs(run);
  }
  void expect_only_named_outputs(const Invocation& run) {
    SCOPED_TRACE(run.arguments);
    const Snapshot before = snapshot_of(root_.path());
    const test::Outcome outcome = program(run.arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const Snapshot after = snapshot_of(root_.path());
    for (const auto& [path, state] : before) {
      const auto found = after.find(path);
      const bool same = found != after.end() && found->second == state;
      const bool replaced = may_appear(path, run) && !planted_.contains(path);  // an older output
      EXPECT_TRUE(same || replaced) << path << " has changed or is gone";
    }
    for (const auto& [path, state] : after)
      EXPECT_TRUE(before.contains(path) || may_appear(path, run)) << path << " has appeared";
    for (const std::string& output : run.outputs)
      EXPECT_TRUE(std::ranges::any_of(after,
                                      [&](const auto& entry) {
                                        return entry.first.starts_with("work/" + output) &&
                                               !before.contains(entry.first);
                                      }))
          << output << " is not written";
  }

  test::TemporaryFolder root_;
  Snapshot planted_;
};

const std::set<std::string> kDraw{"basis", "bench", "report"};

TEST_F(Bystanders, OnlyNamedOutputsAppear) {
  expect_only_named_outputs(kDraw, false);
}

using LongBystanders = Bystanders;
TEST_F(LongBystanders, OnlyNamedOutputsOfDrawingAppear) {
  expect_only_named_outputs(kDraw, true);
}

/// Options that name an output, by their help.
std::vector<std::string> output_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    const std::string help = option->get_description();
    const bool writes = help.find("output") != std::string::npos || help.starts_with("write ") ||
                        help.starts_with("log of") || help.starts_with("folder for");
    if (writes && !option->get_lnames().empty()) names.push_back("--" + option->get_lnames()[0]);
  }
  return names;
}

TEST(BystanderRuns, HaveEveryCommandAndOutput) {
  CLI::App app;
  Shared shared;
  add_commands(app, shared);
  for (const CLI::App* command : app.get_subcommands({})) {
    const auto [first, last] = runs().equal_range(command->get_name());
    EXPECT_TRUE(first != last) << command->get_name() << ": runs() has no run of it";
    for (const std::string& option : output_options(*command)) {
      const std::string word = option == "--output" ? " -o " : " " + option + " ";
      EXPECT_TRUE(std::any_of(first, last,
                              [&](const auto& entry) {
                                return (entry.second.arguments + " ").find(word) !=
                                       std::string::npos;
                              }))
          << command->get_name() << ": runs() has no " << option;
    }
  }
}

}  // namespace
}  // namespace clpv::bystanders_test
