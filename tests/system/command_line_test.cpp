// SPDX-License-Identifier: MIT
// The program as a process: exit codes, help and errors of its output streams. Other tests run
// commands in their own process (support/run_here.hpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/run_here.hpp"

namespace clpv::command_line_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

test::Outcome clpv(const std::string& arguments) {
  return test::run(CLPV_PROGRAM " " + arguments);
}

TEST(CommandLine, ExitCodes) {
  EXPECT_EQ(clpv("--version").exit_code, 0);
  EXPECT_EQ(clpv("basis sh2 --figures /proc/none").exit_code, 1);
  EXPECT_EQ(clpv("rendr").exit_code, 2);
  EXPECT_EQ(clpv("render none.json -o /tmp/none.exr").exit_code, 3);
  EXPECT_EQ(clpv("--device 99 check --stage sizes").exit_code, 4);
  const test::TemporaryFolder kernels;  // one of them computes something else
  kernels.write("sizes.cl", "__kernel void sizes(__global uint* bytes) { bytes[0] = 1; }\n");
  EXPECT_EQ(test::run("CLPV_KERNEL_DIR=" + kernels.path().string() +
                      " " CLPV_PROGRAM " check --stage sizes")
                .exit_code,
            5);
}

TEST(CommandLine, UsageErrorsNameTheProgram) {
  for (const char* arguments :
       {"render", "render a.json --width x", "--frobnicate", "check --stage x"})
    EXPECT_THAT(clpv(arguments).err, ::testing::StartsWith("clpv: ")) << arguments;
  EXPECT_EQ(clpv("render --help").err, "");
}

TEST(CommandLine, HelpIsShortAndHelpAllIsWhole) {
  const test::Outcome bare = clpv("");
  EXPECT_EQ(bare.exit_code, 0);
  EXPECT_EQ(bare.out, clpv("--help").out);
  EXPECT_EQ(bare.err, "");
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

// Every other way to stdout or stderr passes control characters on.
TEST(CommandLine, OneFilePrints) {
  std::vector<std::string> others;
  for (const char* folder : {"/host", "/bench"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(CLPV_SOURCE_DIR + std::string(folder))) {
      if (!entry.is_regular_file() || entry.path().filename() == "log.cpp" ||
          entry.path().filename() == "replay.c")  // a program of its own
        continue;
      const std::string text = test::read_file(entry.path());
      for (const char* way : {"fmt::print(", "printf(std", "fputs(", "std::puts(", "std::cout",
                              "std::cerr", "fwrite("})
        if (text.find(way) != std::string::npos) others.push_back(entry.path().string() + way);
    }
  }
  EXPECT_THAT(others, ::testing::IsEmpty());
}

// They take 0.3 s to load, and most commands read no image.
TEST(CommandLine, StartsWithoutImageCodecs) {
  const test::Outcome libraries = test::run("LD_TRACE_LOADED_OBJECTS=1 " CLPV_PROGRAM);
  EXPECT_THAT(libraries.out, HasSubstr("libOpenCL"));
  EXPECT_THAT(libraries.out, Not(HasSubstr("libOpenImageIO")));
}

}  // namespace
}  // namespace clpv::command_line_test
