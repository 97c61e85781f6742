// SPDX-License-Identifier: MIT
// Output files are complete or absent; lines of progress.
#include "support/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <iterator>

#include "support/input_file.hpp"
#include "support/interrupt.hpp"
#include "support/progress.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::output_file_test {
namespace fs = std::filesystem;

struct OutputFile : ::testing::Test {
  std::size_t entries() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

using test::error_of;
using test::mode_of;
using test::read_file;
using ::testing::HasSubstr;

TEST_F(OutputFile, ReplacesWholeFilesAndLeavesNothingBeside) {
  const fs::path path = folder_ / "out.txt";
  check_writable(path);
  EXPECT_EQ(entries(), 0u);
  write_file(path, std::string_view("a longer first content"));
  write_file(path, std::string_view("second"));
  check_writable(path);
  EXPECT_EQ(read_file(path), "second");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFile, RejectsPathsThatCannotBeFiles) {
  write_file(folder_ / "file", std::string_view("x"));
  for (const fs::path& path : {folder_ / "none/a.exr", folder_, fs::path(), folder_ / "",
                               folder_ / "file/a.exr", fs::path("/dev/null")}) {
    const std::string message = error_of(ExitCode::run_time, [&] { check_writable(path); });
    EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  }
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  ::chmod((folder_ / "file").c_str(), 0444);
  if (::geteuid() != 0) error_of(ExitCode::run_time, [&] { check_writable(folder_ / "file"); });
}

// A link to a missing file was once replaced by the file.
TEST_F(OutputFile, FollowsASymbolicLinkToAFileOrToNone) {
  fs::create_symlink("target", folder_ / "link");
  for (const std::string_view text : {"first", "second"}) {
    write_file(folder_ / "link", text);
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(read_file(folder_ / "target"), text);
  }
}

// Overwriting a private file once made it readable for all.
TEST_F(OutputFile, KeepsTheModeOfTheFileThatItReplaces) {
  const mode_t before = ::umask(027);
  write_file(folder_ / "new", std::string_view("x"));
  EXPECT_EQ(mode_of(folder_ / "new"), 0640u) << "as umask says";
  for (const mode_t mode : {0600u, 0644u, 0666u, 0755u}) {
    ::chmod((folder_ / "new").c_str(), mode);
    write_file(folder_ / "new", std::string_view("y"));
    EXPECT_EQ(mode_of(folder_ / "new"), mode);
  }
  ::umask(before);
}

TEST_F(OutputFile, ARenameThatFailsKeepsWhatIsThereAndSaysSo) {
  clpv::OutputFile output(folder_ / "a");
  fs::create_directories(folder_ / "a/b");
  EXPECT_THAT(error_of(ExitCode::run_time, [&] { output.commit(); }),
              HasSubstr("a: cannot be written: "));
  EXPECT_TRUE(fs::exists(folder_ / "a/b"));
}

TEST_F(OutputFile, SignalsLeaveNoTemporaryFile) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const pid_t child = ::fork();
    if (child == 0) {
      std::signal(signal, SIG_DFL);
      catch_interrupts();
      clpv::OutputFile first(folder_ / "a"), second(folder_ / "b");
      { clpv::OutputFile third(folder_ / "c"); }
      ::raise(signal);
      bool refused = false;
      try {
        write_file(folder_ / "d", "text");
      } catch (const Interrupted&) {
        refused = true;
      }
      if (!refused || entries() != 2) ::_exit(1);  // they end with the work
      ::raise(signal);                             // this one ends the process
      ::_exit(2);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << WEXITSTATUS(status);
    EXPECT_EQ(WTERMSIG(status), signal);
    EXPECT_EQ(entries(), 0u);
  }
}

// An input that was not known when the work began was once replaced at its end.
TEST_F(OutputFile, NoInputIsReplacedEvenIfItIsReadDuringTheWork) {
  const fs::path input = folder_ / "input", late = folder_ / "late", linked = folder_ / "linked";
  for (const fs::path& path : {input, late}) write_file(path, std::string_view("x"));
  fs::create_hard_link(late, linked);
  {
    const InputRecord record;
    clpv::OutputFile output(linked);
    for (const fs::path& path : {input, late}) clpv::read_file(path, 10, "scene.json", "/model");
    const std::string message = error_of(ExitCode::usage, [&] { output.commit(); });
    EXPECT_THAT(message, HasSubstr("linked: found the file of scene.json /model"));
    for (const fs::path& path : {input, late}) {
      error_of(ExitCode::usage, [&] { check_writable(path); });
      error_of(ExitCode::usage, [&] { write_file(path, std::string_view("y")); });
      EXPECT_EQ(read_file(path), "x");
    }
    InputRecord::close();
    write_file(folder_ / "frame", std::string_view("1"));
    clpv::read_file(folder_ / "frame", 10, "frame");
    write_file(folder_ / "frame", std::string_view("2"));
    error_of(ExitCode::usage, [&] { check_writable(input); });
  }
  write_file(input, std::string_view("y"));
  EXPECT_EQ(entries(), 4u);
}

// The temporary file's name was once longer than a name may be.
TEST_F(OutputFile, NamesMayHaveTheirWholeLength) {
  for (const std::size_t length : {240u, 242u, 254u, 255u}) {
    const fs::path path = folder_ / std::string(length, 'a');
    check_writable(path);
    write_file(path, std::string_view("x"));
    EXPECT_EQ(read_file(path), "x");
  }
  const std::string message =
      error_of(ExitCode::run_time, [&] { check_writable(folder_ / std::string(256, 'a')); });
  EXPECT_NE(message.find("File name too long"), std::string::npos) << message;
}

TEST(ProgressLine, ShowsShareAndTimeLeft) {
  EXPECT_EQ(progress_line("tracing", 0, 10, 1, 200),
            "tracing [..............................]   0 % ");
  EXPECT_EQ(progress_line("tracing", 5, 10, 90, 200),
            "tracing [###############...............]  50 % 1:30 left");
  EXPECT_NE(progress_line("tracing", 1, 101, 60, 200).find("1:40:00 left"), std::string::npos);
  EXPECT_NE(progress_line("tracing", 12, 10, 60, 200).find("100 % 0:00 left"), std::string::npos);
  EXPECT_EQ(progress_line("tracing", 5, 10, 90, 10).size(), 10u);
  EXPECT_EQ(progress_line("a\x1b[2Jb", 5, 10, 90, 8), "a?[2Jb [");
}

TEST(ProgressWords, ShowShareAndTimeLeft) {
  EXPECT_EQ(progress_words("quality", 118, 360, 65), "quality: 33 %, 2:13 left");
}

TEST(ProgressLine, NothingIsDrawnWhereStderrIsNoTerminal) {
  testing::internal::CaptureStderr();
  {
    Progress progress("tracing", 2);
    progress.advance();
    progress.advance();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace clpv::output_file_test
