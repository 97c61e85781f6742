// SPDX-License-Identifier: MIT
// Invalid command lines, row by row: bad arguments (exit code 2, before a scene is read or a device
// is opened), devices that do not exist (4), outputs that cannot be written (1, before the work),
// files that cannot be read (3). The message names option or file and the allowed values. No file
// may remain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "support/text.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::hostile_test {
namespace {

namespace fs = std::filesystem;

struct HostileInput {
  std::string name;
  std::string command;  ///< "render @/a.gltf": arguments of clpv; @ is the folder
  int exit_code;
  std::vector<std::string> words;                            ///< on stderr
  std::vector<std::pair<std::string, std::string>> files{};  ///< made in the folder: name, bytes
  /// "HOME=@ XDG_CACHE_HOME=", before the program, through the shell; without, the command runs in
  /// this process.
  std::string surroundings{};
};

std::string with_folder(std::string text, const TemporaryFolder& folder) {
  for (std::size_t at = 0; (at = text.find('@', at)) != std::string::npos;)
    text.replace(at, 1, folder.path().string());
  return text;
}

/// Longer, and it hangs: all are rejected before anything is computed.
constexpr const char* kPatience = "timeout 300 ";

void expect_rejected(const HostileInput& input) {
  SCOPED_TRACE(input.name);
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : input.files) folder.write(name, bytes);
  const std::string command = with_folder(input.command, folder);
  const Outcome outcome = input.surroundings.empty()
                              ? run_here(command, folder.path())
                              : run(with_folder("cd @ && " + input.surroundings + " ", folder) +
                                    kPatience + CLPV_PROGRAM " " + command);
  EXPECT_EQ(outcome.exit_code, input.exit_code) << outcome.err;
  for (const std::string& word : input.words) EXPECT_THAT(outcome.err, ::testing::HasSubstr(word));
  for (const char* foreign :
       {"basic_", "std::", "what()", "terminate", "[json.exception.type_error"})
    EXPECT_THAT(outcome.err, ::testing::Not(::testing::HasSubstr(foreign)));
  EXPECT_THAT(outcome.err, ::testing::ContainsRegex("(^|\n)clpv: "));
  EXPECT_EQ(outcome.err, printable(outcome.err)) << "moves the cursor";
  EXPECT_LT(outcome.err.size(), 4000u) << "a flood of words";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           folder.path(), std::filesystem::directory_options::skip_permission_denied)) {
    const std::string left = entry.path().filename().string();
    EXPECT_FALSE(left.ends_with(".part") || left.ends_with(".new") || left.starts_with("out"))
        << left;
  }
}

struct BadLine {
  std::string arguments;  ///< @ is a folder
  std::vector<std::string> words;
};

void expect_usage(const std::string& before, const std::vector<BadLine>& lines) {
  for (const auto& [arguments, words] : lines)
    expect_rejected({arguments, before + arguments, 2, words});
}

TEST(HostileCommandLines, OfFrames) {
  expect_usage(
      "render " + kCornell + " -o @/out.exr ",
      {
          {"--view inside", {"--view: found 'inside', allowed: full,direct,"}},
          {"--grid 0x10", {"grid", "0x10", "3..512"}},
          {"--cascade-size 1e-30 --view cells", {"cascade-size", "1e-06..10000000"}},
          {"--eye 1e7,0,0 --target 0,0,0 --cascade-size 3", {"cascade-size: found 3", "or more"}},
          {"--iterations 24",
           {"--iterations 24 has no effect with transport sweep (the default)",
            "allowed with transport sampled or exact"}},
          {"--directions 24 --preset paper",
           {"--directions 24 has no effect with transport sampled (set by --preset paper)"}},
          {"--preset paper --transport sweep", {"found 'kernel' (set by --preset paper)"}},
          {"--grid", {"--grid: found no value"}},
          {"--stats --quiet", {"--stats: found the option --quiet, allowed: a value"}},
          {"--samples 64", {"render: unknown option '--samples'; --help-all"}},
          {"--eye 1,2,3", {"--target"}},
          {"--eye 1,2,3 --target 1,2,3", {"the eye itself"}},
          {"--eye 0,0,0 --target 0,1,0", {"parallel"}},
          {"--eye 1,2,3 --target 0,0,0 --camera front", {"--camera"}},
          {"--eye 0,0,0 --target 1,0,0 --fov 180", {"--fov"}},
          {"--sun 0,0,0", {"--sun"}},
          {"--medium=0,05,0,01", {"--medium"}},
          {"--medium 1,1e7", {"--medium: absorption"}},
          {"--light-scale 1e7", {"--light-scale", "1e-06..1000000"}},
          {"--light-scale 2 --sun 0,-1,0", {"--sun"}},
          {"--basis \377\376", {"basis"}},
      });
}

TEST(HostileCommandLines, OfCommands) {
  const std::string film = "sequence " + kCornell + " -o @/out ",
                    quality = "quality " + kCornell + " ", truth = "pathtrace " + kCornell + " ";
  expect_usage("",
               {
                   {"render -o @/out.exr", {"SCENE"}},
                   {"render " + kCornell, {"--output"}},
                   {"render " + kCornell + " -o @/out.bmp", {"'.bmp'", ".exr, .png"}},
                   {"paint it", {"'paint'", "render", "compare"}},
                   {"view " + kCornell, {"python3 -m clpv.view"}},
                   {"report @/out", {"nothing to show"}},
                   {"--quiet", {"subcommand"}},
                   {"bench everything", {"SUITE: found 'everything', allowed: table1,"}},
                   {"bench bases --filter (", {"--filter", "regular expression"}},
                   {"compare a.json b.json --fail-above 0.5", {"--fail-above"}},
                   {"check --stage cook", {"--stage", "gather"}},
                   {"basis sh2 --axis up", {"--axis", "'up'"}},
                   {film + "--frames 2", {"--fps"}},
                   {film + "--frames 2 --fps 0", {"--fps: found '0', allowed: more than 0"}},
                   {film + "--frames 1000000 --fps 0.001", {"--frames", "1000000 s"}},
                   {film + "--frames 2 --fps 1 --video @/out.gif", {"--video", "'.gif'", ".mp4"}},
                   {film + "--frames 2 --fps 1 --traced 4", {"--traced", "--stability"}},
                   {quality + "--vary width=8,16", {"--vary", "one size"}},
                   {quality + "--view inside", {"--view", "inside"}},
                   {quality + "--camera nobody --cache @/c", {"nobody", "allowed: front"}},
                   {truth + "-o @/out.exr --spp 0", {"--spp"}},
                   {truth + "-o @/out.exr --spp 4 --noise 0.1", {"--spp", "--noise"}},
                   {truth + "-o @/out.exr --view cells", {"--view", "cells", "irradiance"}},
                   {"--lanes 2 devices", {"--lanes", "auto,1,8"}},
                   {"render " CLPV_SOURCE_DIR "/scenes/empty_room.glb -o @/out.exr --light-scale 2",
                    {"has no lights"}},
               });
}

TEST(HostileCommandLines, OfDevices) {
  for (const std::string device : {"99", "'no such thing'", "7:7", "-1"})
    expect_rejected(
        {device, "--device=" + device + " check --stage sizes", 4, {words_of(device).front()}});
  expect_rejected({"by the environment", "check --stage sizes", 4, {"'99'"}, {}, "CLPV_DEVICE=99"});
}

TEST(HostileSurroundings, Outputs) {
  const auto rejected = [](const std::string& command, const std::vector<std::string>& words) {
    expect_rejected({command, command, 1, words, {{"file", ""}, {"points.csv", ""}}});
  };
  rejected("render " + kCornell + " -o @/" + std::string(300, 'a') + ".exr", {"cannot be written"});
  for (const std::string& command :
       {"render " + kCornell + " -o @/none/a.exr",
        "render " + kCornell + " -o @/out.exr --stats @/none/a.json",
        std::string("bench bases --output @/none/a.json"),
        "pathtrace " + kCornell + " -o @/none/a.exr",
        "pathtrace " + kCornell + " -o @/out.exr --stats @/none/a.json",
        "quality " + kCornell + " --cache @/out --output @/none/a.json",
        std::string("compare a.exr b.exr -o @/none/a.png"),
        "query " + kCornell + " --points @/points.csv -o @/none/a.csv",
        "bake " + kCornell + " -o @/none/a.npz"})
    rejected(command, {"none/a.", "no folder"});
  for (const std::string& command : {"sequence " + kCornell + " --frames 1 --fps 1 -o @/file",
                                     std::string("report @/file/there " + kCornell)})
    rejected(command, {"file"});
}

TEST(HostileSurroundings, Variables) {
  const auto rejected = [](const std::string& variables, int code,
                           const std::vector<std::string>& words) {
    expect_rejected({variables,
                     "render " + kTiny + kSmallSteps + "-o @/out.exr",
                     code,
                     words,
                     {{"file", ""}},
                     variables});
  };
  rejected("CLPV_PROGRAM_CACHE=none", 2, {"CLPV_PROGRAM_CACHE: found 'none', allowed: on, off"});
  rejected("CLPV_LANES=2", 2, {"CLPV_LANES: 2; allowed: auto, 1 or 8"});
  rejected("CLPV_KERNEL_DIR=@/none", 2, {"CLPV_KERNEL_DIR: found", "a folder with kernel files"});
  rejected("CLPV_PROGRAM_CACHE=off CLPV_PROGRAM_DUMP=@/none", 1, {"none/", "there is no folder"});
  rejected("env POCL_CACHE_DIR=@/file/below", 4, {"no OpenCL device found", "POCL_CACHE_DIR"});
}

// The program as a process: exit codes, help and errors of its output streams. Other tests run
// commands in their own process (support/run_here.hpp).

using ::testing::AllOf;
using ::testing::HasSubstr;

test::Outcome clpv(const std::string& arguments) {
  return test::run(CLPV_PROGRAM " " + arguments);
}

TEST(CommandLine, HelpIsShortAndHelpAllIsWhole) {
  const test::Outcome bare = clpv("");
  EXPECT_EQ(bare.exit_code, 0);
  EXPECT_EQ(bare.out, clpv("--help").out);
  EXPECT_EQ(clpv("help render").out, clpv("render --help").out);
  EXPECT_EQ(bare.err, "");
  EXPECT_EQ(clpv("render --help").err, "");
  EXPECT_EQ(clpv("--version").exit_code, 0);
  const std::string brief = clpv("render --help").out, whole = clpv("render --help-all").out;
  for (const char* common : {"--basis", "--grid", "--transport", "--near", "--output"})
    EXPECT_THAT(brief, HasSubstr(common));
  for (const char* rare :
       {"  --lobe-time=", "  --blocker-stride=", "  --table-size=", "  --rsm-format="}) {
    EXPECT_THAT(brief, ::testing::Not(HasSubstr(rare)));
    EXPECT_THAT(whole, HasSubstr(rare));
  }
  EXPECT_THAT(brief, ::testing::ContainsRegex("--help-all lists [0-9]+ more options?,"));
  EXPECT_THAT(clpv("--help").out,
              AllOf(HasSubstr("Look:"), HasSubstr("Measure:"), HasSubstr("Verify:"),
                    HasSubstr("Exit codes"), ::testing::Not(HasSubstr("prepare"))));
  EXPECT_THAT(clpv("--help-all").out,
              AllOf(HasSubstr("--transport"), HasSubstr("--frames"), HasSubstr("--vary")));
}

TEST(CommandLine, AClosedPipeEndsTheProgram) {
  // SIGPIPE ends the program without a message, like any other.
  // The reader ends before the program starts.
  const test::TemporaryFolder folder;
  const std::string ended = (folder / "ended").string();
  const test::Outcome outcome =
      test::run("mkfifo " + ended + "; { read _ <" + ended + "; " CLPV_PROGRAM " basis; echo $? >" +
                (folder / "code").string() + "; } | { exec 0<&-; echo >" + ended + "; }");
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(test::read_file(folder / "code"), "141\n");
}

TEST(CommandLine, WriteErrorsOfStdoutAreReported) {
  for (const char* arguments :
       {"", "--help", "--help-all", "--version", "render --help", "devices",
        "devices --format json", "basis sh2", "basis sh2 --format json", "check --list"}) {
    const test::Outcome full = clpv(std::string(arguments) + " >/dev/full"),
                        closed = clpv(std::string(arguments) + " >&-");
    EXPECT_EQ(full.exit_code, 1) << arguments;
    EXPECT_THAT(full.err, HasSubstr("stdout: cannot be written: No space left on device"));
    EXPECT_EQ(closed.exit_code, 1) << arguments;
    EXPECT_THAT(closed.err, HasSubstr("stdout: cannot be written: Bad file descriptor"));
  }
}

// They take 0.3 s to load, and most commands read no image.
TEST(CommandLine, StartsWithoutImageCodecs) {
  const test::Outcome libraries = test::run("LD_TRACE_LOADED_OBJECTS=1 " CLPV_PROGRAM);
  EXPECT_THAT(libraries.out, HasSubstr("libOpenCL"));
  EXPECT_THAT(libraries.out, testing::Not(HasSubstr("libOpenImageIO")));
}

}  // namespace
}  // namespace clpv::test::hostile_test
